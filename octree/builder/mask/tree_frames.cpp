#include "octree/builder/mask/tree_frames.h"

#include <algorithm>
#include <new>

#include "octree/geometry/strict_math.h"
#include "octree/page/page_decoder.h"

namespace planetree::octree {

TreeFrames::TreeFrames(const BuiltTrees& trees, const BuiltMask* mask)
    : trees_(trees),
      mask_(mask),
      page_lines_(trees.surface->info_of_page(0).page_bytes / kSlotBytes),
      max_(std::min<std::size_t>(trees.page_count() + (mask ? mask->size() : 0),
                                 kBytes / kSlotBytes / page_lines_)) {
  lines_.reserve(max_ * page_lines_);
  frames_.reserve(max_);
}

const std::byte* TreeFrames::page(void* frames, std::uint32_t number) noexcept {
  auto& self = *static_cast<TreeFrames*>(frames);
  const auto found = self.frame_of_.find(number);
  if (found != self.frame_of_.end()) {
    self.frames_[found->second].last_use = ++self.uses_;
    return self.bytes_of(found->second).data();
  }
  try {
    return self.load_page(number);
  } catch (const std::bad_alloc&) {
    if (self.state_)
      self.state_ = make_error(ErrorCode::kNoMemory, number, Error::kNowhere,
                               "no memory for a page that is read again; free some and try again");
    return nullptr;
  }
}

const std::byte* TreeFrames::peek(void* frames, std::uint32_t number) noexcept {
  auto& self = *static_cast<TreeFrames*>(frames);
  const auto found = self.frame_of_.find(number);
  return found == self.frame_of_.end() ? nullptr : self.bytes_of(found->second).data();
}

Result<void> TreeFrames::decode(std::uint32_t number, std::span<std::byte> frame) const {
  const std::uint32_t tree_pages = trees_.page_count();
  if (number < tree_pages) {
    const BuiltTree& tree = trees_.tree_of_page(number);
    const auto raw = tree.pages().encode(number);
    if (!raw) return raw.error();
    return decode_page(raw->bytes, tree.info_of_page(number), frame);
  }
  const auto raw = mask_->encode(number - tree_pages, tree_pages);
  if (!raw) return raw.error();
  PageInfo info = trees_.surface->info_of_page(0);
  info.first_page = info.tree_pages = tree_pages;
  info.page_count = mask_->size();
  info.page_number = number;
  info.octcode = raw->octcode;
  return decode_mask_page(raw->bytes, info, frame);
}

const std::byte* TreeFrames::load_page(std::uint32_t number) {
  const std::size_t frame = acquire_frame();
  const std::span<std::byte> bytes = bytes_of(frame);
  const Result<void> decoded = decode(number, bytes);
  if (!decoded) {
    if (state_) state_ = decoded;
    frames_[frame] = {};
    return nullptr;
  }
  frame_of_.emplace(number, frame);
  frames_[frame] = {number, ++uses_};
  return bytes.data();
}

// A free frame, or else the one that was least recently used.
std::size_t TreeFrames::acquire_frame() {
  if (frames_.size() < max_) {
    lines_.resize(lines_.size() + page_lines_);
    frames_.emplace_back();
    return frames_.size() - 1;
  }
  const auto oldest =
      std::min_element(frames_.begin(), frames_.end(),
                       [](const Frame& a, const Frame& b) { return a.last_use < b.last_use; });
  frame_of_.erase(oldest->page);
  return static_cast<std::size_t>(oldest - frames_.begin());
}

std::span<std::byte> TreeFrames::bytes_of(std::size_t frame) {
  return {lines_[frame * page_lines_].bytes, page_lines_ * kSlotBytes};
}

}  // namespace planetree::octree
