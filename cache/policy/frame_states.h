#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

namespace planetree::cache {

/// Frame index that means "no frame".
inline constexpr std::uint32_t kNoFrame = ~std::uint32_t{0};

/// State of each frame. Only the writer, the holder of the cache's mutex, reads or changes it.
///
///     idle --install--> evictable --pin--> pinned, and back by unpin()
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
  bool is_evictable(std::uint32_t frame) const noexcept {
    return states_[frame] == State::kEvictable;
  }
  std::size_t size() const noexcept { return states_.size(); }

  void install(std::uint32_t frame) noexcept { change(frame, State::kIdle, State::kEvictable); }
  void remove(std::uint32_t frame) noexcept { change(frame, State::kEvictable, State::kIdle); }
  void pin(std::uint32_t frame) noexcept {
    assert(states_[frame] != State::kIdle);
    states_[frame] = State::kPinned;
  }
  /// Makes a pinned frame evictable.
  void unpin(std::uint32_t frame) noexcept { change(frame, State::kPinned, State::kEvictable); }
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
