#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/frame_pool.h"

namespace planetree::cache {

/// What may become of each frame's page. Changed by the writer alone:
///
///     idle --install--> evictable --pin--> pinned
///      ^___remove_______|   ^
///                           |--hold--> held, and back by release()
///
/// A held frame stays for a while: somebody who waited for its page has not come for it yet.
/// A view of memory that PageCache owns.
class FrameStates {
 public:
  enum class State : std::uint8_t { kIdle = 0, kEvictable, kHeld, kPinned };

  /// One element per frame, all 0.
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
  /// Of a frame that is evictable, held or pinned: what is pinned stays so.
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
