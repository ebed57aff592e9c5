#include "octree/builder/tree/tree_pages.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

#include "octree/builder/tree/float_rounding.h"
#include "octree/builder/tree/page_encoder.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {

TreePages::TreePages(TopTree& top_tree, const std::vector<BuiltChunk>& chunks,
                     const PageNumbers& numbers, const BlockShape& shape,
                     const storage::SpillFile& file)
    : top_tree_(top_tree), chunks_(chunks), numbers_(numbers), shape_(shape), file_(file) {
  PagePlan& plan = top_tree.plan;
  plan.node_links.resize(top_tree.tree.nodes.size());
  for (std::uint32_t chunk = 0; chunk < chunks.size(); ++chunk)
    plan.block_links.push_back({numbers.chunk_page(chunk, 0), 0});
  for (std::size_t i = 0; i < plan.pages.size(); ++i) {
    PlannedPage& page = plan.pages[i];
    page.number = numbers.top_tree_page(i);
    page.ordinal = numbers.page(page.number).ordinal;
    StoredLink link{page.number, 0};
    for (const std::uint32_t node : page.nodes) {
      plan.node_links[node] = link;
      ++link.record;
    }
  }
}

std::optional<FloatBox> TreePages::box_of(std::uint32_t first, std::uint32_t end) const {
  std::optional<FloatBox> box;
  first = std::max(first, this->first());
  end = std::min(end, this->first() + size());
  for (std::uint32_t number = first; number < end; ++number) {
    const std::uint32_t chunk = numbers_.page(number).chunk;
    if (chunk == NumberedPage::kTopTree) continue;
    if (!box) box = empty_box();
    extend(*box, chunks_[chunk].box);
  }
  return box;
}

Result<FilePage> TreePages::encode(std::uint32_t number) const {
  const NumberedPage& page = numbers_.page(number);
  if (page.chunk == NumberedPage::kTopTree) {
    const Triangles none;
    const ChunkVertices no_vertices(none);
    const PageEncoder encoder(none, no_vertices, {}, top_tree_.tree, top_tree_.plan, shape_);
    return FilePage{page.octcode, page.ordinal, encoder.encode(page.index).bytes};
  }
  auto raw = read_spilled_page(
      chunks_[page.chunk].pages[page.index], file_, number,
      [&](std::uint32_t index) { return numbers_.chunk_page(page.chunk, index); });
  if (!raw) return raw.error();
  std::memcpy(raw->data() + offsetof(PageHead, ordinal), &page.ordinal, sizeof page.ordinal);
  const SpilledPage& spilled = chunks_[page.chunk].pages[page.index];
  return FilePage{page.octcode, page.ordinal, *std::move(raw),
                  spilled.links_at + spilled.link_count * kPageLinkBytes};
}

}  // namespace planetree::octree
