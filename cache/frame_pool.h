#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "cache/prefaulted_memory.h"
#include "planetree/error.h"

namespace planetree::cache {

/// Frames start on a cache line, so that the layout of a decoded page can follow cache lines.
inline constexpr std::uint64_t kFrameAlignmentBytes = 64;

/// Memory of the frames that hold decoded pages, claimed once. It never grows. Move-only.
/// PageCache decides who may write a frame and when.
class FramePool {
 public:
  /// Claims `frame_count` > 0 frames of `frame_bytes` > 0 bytes each.
  /// errors  kNoMemory.
  static Result<FramePool> create(std::uint32_t frame_count, std::uint32_t frame_bytes) noexcept {
    assert(frame_count > 0 && frame_bytes > 0);
    // The product is at most (2^32 - 1) * 2^32, so it cannot wrap.
    Result<PrefaultedMemory> memory =
        PrefaultedMemory::claim(frame_count * stride_bytes(frame_bytes));
    if (!memory) return memory.error();
    return FramePool(*std::move(memory), frame_count, frame_bytes);
  }

  /// Bytes from the start of one frame to the start of the next.
  static constexpr std::uint64_t stride_bytes(std::uint32_t frame_bytes) noexcept {
    return (frame_bytes + kFrameAlignmentBytes - 1) / kFrameAlignmentBytes * kFrameAlignmentBytes;
  }

  /// Start of a frame: frame_bytes() bytes, 64-byte aligned.
  std::byte* frame(std::uint32_t index) const noexcept {
    assert(index < frame_count_);
    return memory_.data() + index * stride_bytes_;
  }
  std::uint32_t frame_count() const noexcept { return frame_count_; }
  std::uint32_t frame_bytes() const noexcept { return frame_bytes_; }
  std::uint64_t stride_bytes() const noexcept { return stride_bytes_; }
  /// Gives the memory of a frame back to the system; reclaim() backs it again.
  void discard(std::uint32_t index) const noexcept {
    memory_.discard(index * stride_bytes_, stride_bytes_);
  }
  /// See PrefaultedMemory::commit().
  Result<void> reclaim(std::uint32_t index, bool is_locked) const noexcept {
    return memory_.commit(index * stride_bytes_, stride_bytes_, is_locked);
  }
  /// See PrefaultedMemory::lock().
  bool lock() const noexcept { return memory_.lock(); }
  /// Bytes of memory that the pool holds, rounding included.
  std::uint64_t arena_bytes() const noexcept { return memory_.bytes(); }

 private:
  FramePool(PrefaultedMemory memory, std::uint32_t frame_count, std::uint32_t frame_bytes) noexcept
      : memory_(std::move(memory)),
        stride_bytes_(stride_bytes(frame_bytes)),
        frame_count_(frame_count),
        frame_bytes_(frame_bytes) {}

  PrefaultedMemory memory_;
  std::uint64_t stride_bytes_;
  std::uint32_t frame_count_;
  std::uint32_t frame_bytes_;
};

}  // namespace planetree::cache
