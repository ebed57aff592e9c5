#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

/// What holders of frames tell those that look at them: where they are, and when they may go.
namespace planetree::octree {

/// Where frames are, for whoever asks for lines of theirs ahead: nothing is read there, so that it
/// does not matter if a page goes meanwhile.
struct FrameTable {
  const std::atomic<std::uint32_t>* cells = nullptr;  ///< a page's frame + 1; 0: not resident
  const std::byte* frames = nullptr;
  std::uint64_t stride_bytes = 0;  ///< from frame to frame

  /// By no branch; of a page that is not resident another's.
  const std::byte* frame_of(std::uint32_t page) const {
    const std::uint32_t cell = cells[page].load(std::memory_order_relaxed);
    return frames + stride_bytes * (cell - static_cast<std::uint32_t>(cell != 0));
  }
};

/// Whoever keeps pointers to frames from call to call: told before these may go.
struct FrameReleaseHook {
  void* who = nullptr;
  void (*on_release)(void* who) noexcept = nullptr;
};

}  // namespace planetree::octree
