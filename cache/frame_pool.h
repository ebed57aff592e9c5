#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>

#include "cache/prefaulted_memory.h"
#include "planetree/error.h"

namespace planetree::cache {

/// Says that a page has no frame, or that no frame is to be had.
inline constexpr std::uint32_t kNoFrame = ~std::uint32_t{0};

/// Frames begin on a cache line, so that a decoded page may be laid out by
/// lines.
inline constexpr std::uint64_t kFrameAlignmentBytes = 64;

/// The frames that hold decoded pages: one arena, claimed once, never grown.
/// Move-only. Who may write a frame, and when, is the business of PageCache.
class FramePool {
 public:
  /// Claims `frame_count` > 0 frames of `frame_bytes` > 0 bytes each.
  /// Fails with kNoMemory.
  static Result<FramePool> create(std::uint32_t frame_count, std::uint32_t frame_bytes) noexcept;

  /// Bytes from one frame to the next.
  static constexpr std::uint64_t stride_bytes(std::uint32_t frame_bytes) noexcept {
    return (frame_bytes + kFrameAlignmentBytes - 1) / kFrameAlignmentBytes * kFrameAlignmentBytes;
  }

  /// Start of a frame, 64-byte aligned; frame_bytes() bytes may be used.
  std::byte* frame(std::uint32_t index) const noexcept {
    assert(index < frame_count_);
    return memory_.data() + index * stride_bytes_;
  }
  std::uint32_t frame_count() const noexcept { return frame_count_; }
  std::uint32_t frame_bytes() const noexcept { return frame_bytes_; }
  std::uint64_t stride_bytes() const noexcept { return stride_bytes_; }
  /// As PrefaultedMemory::lock().
  bool lock() const noexcept { return memory_.lock(); }
  /// All memory the pool holds.
  std::uint64_t arena_bytes() const noexcept { return memory_.bytes(); }

 private:
  FramePool(PrefaultedMemory memory, std::uint32_t frame_count, std::uint32_t frame_bytes) noexcept;

  PrefaultedMemory memory_;
  std::uint64_t stride_bytes_;
  std::uint32_t frame_count_;
  std::uint32_t frame_bytes_;
};

}  // namespace planetree::cache
