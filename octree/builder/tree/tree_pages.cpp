#include "octree/builder/tree/tree_pages.h"

#include <cstddef>
#include <cstring>
#include <utility>

#include "octree/builder/tree/page_encoder.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {

TreePages::TreePages(TopTree& top_tree, const std::vector<BuiltChunk>& chunks,
                     const PageNumbers& numbers, const BlockShape& shape,
                     const storage::SpillFile& file)
    : top_tree_(top_tree), chunks_(chunks), numbers_(numbers), shape_(shape), file_(file) {
  PagePlan& plan = top_tree.plan;
  const LinkFormat links(plan.page_bytes);
  plan.node_links.resize(top_tree.tree.nodes.size());
  for (std::uint32_t chunk = 0; chunk < chunks.size(); ++chunk)
    plan.block_links.push_back(numbers.link(chunk, chunks[chunk].root_link));
  for (std::size_t i = 0; i < plan.pages.size(); ++i) {
    PlannedPage& page = plan.pages[i];
    page.number = numbers.top_tree_page(i);
    page.ordinal = numbers.page(page.number).ordinal;
    std::uint32_t slot = frame_head_slots(plan.page_bytes);
    for (const std::uint32_t node : page.nodes) {
      plan.node_links[node] = links.make(false, page.number, slot);
      slot += shape.node_slots();
    }
  }
}

std::uint32_t TreePages::root_link() const {
  return top_tree_.tree.nodes.empty() ? top_tree_.plan.block_links[0]
                                      : top_tree_.plan.node_links[0];
}

Result<FilePage> TreePages::encode(std::uint32_t number) const {
  const NumberedPage& page = numbers_.page(number);
  if (page.chunk == NumberedPage::kTopTree) {
    const Triangles none;
    const ChunkVertices no_vertices(none);
    const PageEncoder encoder(none, no_vertices, {}, top_tree_.tree, top_tree_.plan, shape_);
    return FilePage{page.octcode, page.ordinal, encoder.encode(page.index).bytes};
  }
  auto raw = read_spilled_page(chunks_[page.chunk].pages[page.index], file_, number,
                               [&](std::uint32_t link) { return numbers_.link(page.chunk, link); });
  if (!raw) return raw.error();
  std::memcpy(raw->data() + offsetof(PageHead, ordinal), &page.ordinal, sizeof page.ordinal);
  const SpilledPage& spilled = chunks_[page.chunk].pages[page.index];
  return FilePage{page.octcode, page.ordinal, *std::move(raw),
                  spilled.links_at + spilled.link_count * sizeof(std::uint32_t)};
}

}  // namespace planetree::octree
