#include "octree/builder/mask/height_field_marks.h"

#include <cstring>
#include <utility>

#include "octree/geometry/strict_math.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {
namespace {

/// Maximum of nodes and blocks to visit in a page, for each block that is looked at. Those of
/// ordinary models take a quarter of it; the boxes around needles meet thousands of blocks.
constexpr std::uint64_t kVisitsPerBlock = 128;

}  // namespace

HeightFieldMarks::HeightFieldMarks(const BuiltTrees& trees, const BuiltMask& mask)
    : info_(trees.info(cap_info_)), workspaces_([trees, &mask] {
        return Workspace{TreeFrames(trees, &mask), {}};
      }) {
  mask_.page_bytes = info_.page_bytes;
  mask_.first_page = trees.page_count();
  mask_.page_count = mask.size();
  mask_.lower = info_.core_lower;
  mask_.beside_strays = info_.has_strays;
}

Result<void> HeightFieldMarks::mark(std::uint32_t number, FilePage& page) {
  Workspace& workspace = workspaces_.local();
  const PageReader pages = workspace.frames.reader();
  const std::byte* frame = pages.page(pages.context, number);
  if (!frame) return workspace.frames.state();
  const FrameHeader header = *reinterpret_cast<const FrameHeader*>(frame);
  workspace.page.resize(header.used_bytes / kSlotBytes);
  std::memcpy(workspace.page.data(), frame, header.used_bytes);
  std::vector<std::pair<std::size_t, BlockView>> promising;
  std::size_t slot = header.first_block_slot;
  for (std::size_t i = 0; i < header.block_count; ++i) {
    const BlockView block(workspace.page[slot].bytes, info_.shape);
    if (HeightFieldFinder::may_be_height_field(block)) promising.emplace_back(i, block);
    slot += block.slots();
  }
  // Where few blocks of a page pass, the triangles of neighbours make the proof fail for most of
  // these.
  if (2 * promising.size() < header.block_count) promising.clear();
  const HeightFieldFinder finder(info_, mask_);
  TraversalStats work;
  for (const auto& [i, block] : promising) {
    if (work.nodes + work.blocks > kVisitsPerBlock * promising.size()) break;
    if (finder.is_height_field(block, pages, work))
      page.bytes[page.blocks_at + i] |= std::byte{kHeightFieldBit};
  }
  return workspace.frames.state();
}

}  // namespace planetree::octree
