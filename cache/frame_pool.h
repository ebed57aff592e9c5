#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "cache/prefaulted_memory.h"
#include "planetree/error.h"

namespace planetree::cache {

/// Frame index that means "no frame".
inline constexpr std::uint32_t kNoFrame = ~std::uint32_t{0};

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

/// State of each frame. Only the writer, the holder of the cache's mutex, reads or changes it.
///
///     idle --install--> evictable --pin--> pinned
///      ^___remove_______|   ^
///                           |--hold--> held, and back by release()
///
/// An idle frame has no page. The page of a held frame must not be evicted yet: a thread that
/// waited for it has still to take it. A held frame may be pinned too.
/// A view of memory that PageCache owns.
class FrameStates {
 public:
  enum class State : std::uint8_t { kIdle = 0, kEvictable, kHeld, kPinned };

  /// `states` has one element per frame, all 0.
  explicit FrameStates(std::span<State> states) noexcept : states_(states) {
    assert(!states.empty() && states.size() < kNoFrame);
  }

  State of(std::uint32_t frame) const noexcept { return states_[frame]; }
  std::size_t size() const noexcept { return states_.size(); }

  void install(std::uint32_t frame) noexcept { change(frame, State::kIdle, State::kEvictable); }
  void remove(std::uint32_t frame) noexcept { change(frame, State::kEvictable, State::kIdle); }
  void pin(std::uint32_t frame) noexcept {
    assert(states_[frame] != State::kIdle);
    states_[frame] = State::kPinned;
  }
  /// Holds an evictable frame. Has no effect on a held or pinned frame. Not for idle frames.
  void hold(std::uint32_t frame) noexcept {
    assert(states_[frame] != State::kIdle);
    if (states_[frame] == State::kEvictable) states_[frame] = State::kHeld;
  }
  void release(std::uint32_t frame) noexcept {
    assert(states_[frame] != State::kIdle);
    if (states_[frame] == State::kHeld) states_[frame] = State::kEvictable;
  }

 private:
  void change(std::uint32_t frame, [[maybe_unused]] State from, State to) noexcept {
    assert(states_[frame] == from);
    states_[frame] = to;
  }

  std::span<State> states_;
};

}  // namespace planetree::cache
