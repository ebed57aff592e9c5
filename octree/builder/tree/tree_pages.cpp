#include "octree/builder/tree/tree_pages.h"

#include <cstddef>
#include <cstring>
#include <utility>

#include "octree/builder/tree/page_encoder.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {

TreePages::TreePages(Crown& crown, const std::vector<BuiltPatch>& patches,
                     const PageNumbers& numbers, const BlockShape& shape,
                     const storage::SpillFile& file)
    : crown_(crown), patches_(patches), numbers_(numbers), shape_(shape), file_(file) {
  PagePlan& plan = crown.plan;
  const LinkFormat links(plan.page_bytes);
  plan.node_links.resize(crown.tree.nodes.size());
  for (std::uint32_t patch = 0; patch < patches.size(); ++patch)
    plan.block_links.push_back(numbers.link(patch, patches[patch].root_link));
  for (std::size_t i = 0; i < plan.pages.size(); ++i) {
    PlannedPage& page = plan.pages[i];
    page.number = numbers.crown_page(i);
    page.ordinal = numbers.pages()[page.number].ordinal;
    std::uint32_t slot = frame_head_slots(plan.page_bytes);
    for (const std::uint32_t node : page.nodes) {
      plan.node_links[node] = links.make(false, page.number, slot);
      slot += shape.node_slots();
    }
  }
}

std::uint32_t TreePages::root_link() const {
  return crown_.tree.nodes.empty() ? crown_.plan.block_links[0] : crown_.plan.node_links[0];
}

Result<FilePage> TreePages::encode(std::uint32_t number) const {
  const NumberedPage& page = numbers_.pages()[number];
  if (page.patch == NumberedPage::kCrown) {
    const Triangles none;
    const PatchVertices no_vertices(none);
    const PageEncoder encoder(none, no_vertices, {}, crown_.tree, crown_.plan, shape_);
    return FilePage{page.octcode, page.ordinal, encoder.encode(page.place).bytes};
  }
  auto raw = get_back(patches_[page.patch].pages[page.place], file_, number,
                      [&](std::uint32_t link) { return numbers_.link(page.patch, link); });
  if (!raw) return raw.error();
  std::memcpy(raw->data() + offsetof(PageHead, ordinal), &page.ordinal, sizeof page.ordinal);
  const SpilledPage& spilled = patches_[page.patch].pages[page.place];
  return FilePage{page.octcode, page.ordinal, *std::move(raw),
                  spilled.links_at + spilled.link_count * sizeof(std::uint32_t)};
}

}  // namespace planetree::octree
