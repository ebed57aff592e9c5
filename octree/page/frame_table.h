#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

/// Interface between the cache, which holds frames, and readers that keep or prefetch pointers to
/// them.
namespace planetree::octree {

/// Addresses of frames for prefetching. Nothing is read through these addresses, so that a page may
/// be evicted meanwhile.
struct FrameTable {
  const std::atomic<std::uint32_t>* cells = nullptr;  ///< frame + 1; 0: not resident
  const std::byte* frames = nullptr;
  std::uint64_t stride_bytes = 0;  ///< distance from frame to frame

  /// Returns the frame of a page, or some other page's frame if the page is not resident. Has no
  /// branch.
  const std::byte* frame_of(std::uint32_t page) const {
    const std::uint32_t cell = cells[page].load(std::memory_order_relaxed);
    return frames + stride_bytes * (cell - static_cast<std::uint32_t>(cell != 0));
  }
};

/// Callback of a reader that keeps pointers to frames between calls. It is called before those
/// frames may be reused.
struct FrameReleaseHook {
  void* context = nullptr;
  void (*on_release)(void* context) noexcept = nullptr;
};

}  // namespace planetree::octree
