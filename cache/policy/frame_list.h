#pragma once

#include <cassert>
#include <cstdint>
#include <span>

#include "cache/policy/frame_states.h"

namespace planetree::cache {

/// What a policy with queues keeps for each frame.
struct FrameNode {
  std::uint32_t newer;  ///< next frame towards the newest in its list; kNoFrame at the end
  std::uint32_t older;  ///< next frame towards the oldest
  std::uint32_t page;   ///< page installed last
  bool in_main;         ///< of two lists, whether the frame is in the one of proven pages
};

/// A queue of frames, doubly linked. Several lists may share the nodes if no frame is in two of
/// them. A view of memory that PageCache owns.
class FrameList {
 public:
  /// `nodes` has one element per frame.
  explicit FrameList(std::span<FrameNode> nodes) noexcept : nodes_(nodes) {}

  std::uint32_t size() const noexcept { return size_; }
  /// Return kNoFrame at the end of the list.
  std::uint32_t oldest() const noexcept { return oldest_; }
  std::uint32_t newer(std::uint32_t frame) const noexcept { return nodes_[frame].newer; }

  /// Adds a frame that is in no list.
  void add_newest(std::uint32_t frame) noexcept {
    nodes_[frame].newer = kNoFrame;
    nodes_[frame].older = newest_;
    (newest_ == kNoFrame ? oldest_ : nodes_[newest_].newer) = frame;
    newest_ = frame;
    ++size_;
  }

  void erase(std::uint32_t frame) noexcept {
    assert(size_ > 0);
    const FrameNode& node = nodes_[frame];
    (node.older == kNoFrame ? oldest_ : nodes_[node.older].newer) = node.newer;
    (node.newer == kNoFrame ? newest_ : nodes_[node.newer].older) = node.older;
    --size_;
  }

 private:
  std::span<FrameNode> nodes_;
  std::uint32_t newest_ = kNoFrame, oldest_ = kNoFrame;
  std::uint32_t size_ = 0;
};

}  // namespace planetree::cache
