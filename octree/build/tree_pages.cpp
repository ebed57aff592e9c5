#include "octree/build/tree_pages.h"

#include <cstring>

#include "octree/build/page_encoder.h"
#include "octree/build/shuffled_links.h"
#include "octree/page_streams.h"

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
    page.ordinal = ordinal(page.number);
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

Result<std::vector<std::byte>> TreePages::encode(std::uint32_t number) const {
  const NumberedPage& page = numbers_.pages()[number];
  if (page.patch != NumberedPage::kCrown) return fetch(number);
  const Triangles none;
  const PatchVertices no_vertices(none);
  return PageEncoder(none, no_vertices, {}, crown_.tree, crown_.plan, shape_)
      .encode(page.place)
      .bytes;
}

Result<std::vector<std::byte>> TreePages::fetch(std::uint32_t number) const {
  const NumberedPage& page = numbers_.pages()[number];
  const SpilledPage& spilled = patches_[page.patch].pages[page.place];
  std::vector<std::byte> raw(spilled.raw_bytes);
  if (const auto read = file_.read(spilled.offset, raw); !read) return read.error();
  PageHead head;
  std::memcpy(&head, raw.data(), sizeof head);
  head.page_number = number;
  head.ordinal = page.ordinal;
  std::memcpy(raw.data(), &head, sizeof head);
  replace_links(raw.data() + spilled.links_at, spilled.link_count,
                [&](std::uint32_t link) { return numbers_.link(page.patch, link); });
  return raw;
}

}  // namespace planetree::octree
