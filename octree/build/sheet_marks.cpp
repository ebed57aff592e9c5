#include "octree/build/sheet_marks.h"

#include <cstring>
#include <utility>

#include "octree/page_streams.h"
#include "octree/strict_math.h"

namespace planetree::octree {

SheetMarks::SheetMarks(const BuiltTree& tree, const BuiltMask& mask)
    : tree_(tree), built_mask_(mask), facts_(tree.facts()) {
  mask_.page_bytes = facts_.page_bytes;
  mask_.first_page = tree.pages().size();
  mask_.page_count = mask.size();
  mask_.lower = facts_.box_lower;
}

Result<void> SheetMarks::mark(std::uint32_t number, FilePage& page) {
  std::unique_ptr<Desk> desk = take_desk();
  const PageReader pages = desk->frames.reader();
  const std::byte* frame = pages.page(pages.context, number);
  if (!frame) return desk->frames.state();
  const FrameHeader header = *reinterpret_cast<const FrameHeader*>(frame);
  desk->page.resize(header.used_bytes / kSlotBytes);
  std::memcpy(desk->page.data(), frame, header.used_bytes);
  std::vector<BlockView> blocks;
  std::size_t promising = 0;
  for (std::size_t slot = header.first_block_slot; blocks.size() < header.block_count;) {
    blocks.emplace_back(desk->page[slot].bytes, facts_.shape);
    promising += SheetFinder::may_be_in_sheet(blocks.back()) ? 1 : 0;
    slot += facts_.shape.slots(blocks.back().header().vertex_count);
  }
  // Where few blocks may be, their neighbours prove most of those not to be.
  const bool worthwhile = 2 * promising >= blocks.size();
  const SheetFinder finder(facts_, mask_);
  for (std::size_t i = 0; worthwhile && i < blocks.size(); ++i)
    if (finder.is_in_sheet(blocks[i], pages))
      page.bytes[page.blocks_at + i] |= std::byte{kSheetBit};
  Result<void> state = desk->frames.state();
  give_back(std::move(desk));
  return state;
}

std::unique_ptr<SheetMarks::Desk> SheetMarks::take_desk() {
  {
    const std::lock_guard lock(mutex_);
    if (!desks_.empty()) {
      std::unique_ptr<Desk> desk = std::move(desks_.back());
      desks_.pop_back();
      return desk;
    }
  }
  return std::unique_ptr<Desk>(new Desk{TreeFrames(tree_, &built_mask_), {}});
}

void SheetMarks::give_back(std::unique_ptr<Desk> desk) {
  const std::lock_guard lock(mutex_);
  desks_.push_back(std::move(desk));
}

}  // namespace planetree::octree
