#pragma once

#include <array>
#include <cstdint>

#include "tests/cache/explored_cache.h"
#include "tests/cache/explorer/program.h"

namespace planetree::cache {

/// Size of a TurnoverProgram, and mistakes to make on purpose.
struct Turnover {
  std::uint32_t readers = 1;   ///< threads
  std::uint32_t sections = 1;  ///< sections of each reader
  std::uint32_t frames = 1;    ///< 1 or 2
  std::uint32_t rounds = 1;    ///< each round gives every frame the other page
  bool notes_sections_too_early = false;
  bool reuses_at_once = false;
  bool shows_the_wrong_page = false;
};

/// Readers look up two pages while one writer keeps exchanging which page is in which frame. This
/// is the smallest program in which every step of the protocol matters. The writer follows
/// PageCache when it evicts and fills.
class TurnoverProgram final : public explorer::Program {
 public:
  explicit TurnoverProgram(const Turnover& turnover)
      : turnover_(turnover),
        cache_(turnover.readers, turnover.frames, kPageCount, turnover.frames) {}

  std::uint32_t thread_count() const noexcept override { return turnover_.readers + 1; }

  void run(std::uint32_t thread) override {
    if (thread == turnover_.readers) {
      write();
    } else {
      for (std::uint32_t i = 0; i < turnover_.sections; ++i) read_section(cache_.slot(thread));
    }
  }

 private:
  static constexpr std::uint32_t kPageCount = 2;
  static constexpr std::uint32_t kTries = 3;

  /// Reads every frame found so far again after each lookup.
  void read_section(ExploredCache::Slot& slot) {
    std::array<std::uint32_t, kPageCount> found;
    slot.enter();
    for (std::uint32_t looked = 0; looked < kPageCount; ++looked) {
      found[looked] = cache_.map().find(looked);
      for (std::uint32_t page = 0; page <= looked; ++page) {
        if (found[page] != kNoFrame) cache_.read(found[page], page);
      }
    }
    slot.leave();
  }

  void write() {
    for (std::uint32_t round = 0; round < turnover_.rounds; ++round) {
      // Evicts all frames before it fills one, so that pages change frames.
      for (std::uint32_t frame = 0; frame < turnover_.frames; ++frame) evict(frame);
      for (std::uint32_t fetcher = 0; fetcher < turnover_.frames; ++fetcher) {
        const std::uint32_t frame = turnover_.reuses_at_once ? fetcher : take(fetcher);
        if (frame == kNoFrame) return;
        const std::uint32_t page = 1 - cache_.page_in(frame);
        cache_.install(frame, page);
        if (turnover_.shows_the_wrong_page) cache_.map().publish(1 - page, frame);
      }
    }
  }

  /// The frame with number i is retired by fetcher i.
  void evict(std::uint32_t frame) {
    if (turnover_.notes_sections_too_early) cache_.limbo().retire(frame, frame);
    cache_.map().withdraw(cache_.page_in(frame));
    if (!turnover_.notes_sections_too_early) cache_.limbo().retire(frame, frame);
  }

  std::uint32_t take(std::uint32_t fetcher) {
    for (std::uint32_t i = 1; i < kTries; ++i) {
      const std::uint32_t frame = cache_.limbo().take(fetcher);
      if (frame != kNoFrame) return frame;
      explorer::Execution::current().yield();
    }
    return cache_.limbo().take(fetcher);
  }

  Turnover turnover_;
  ExploredCache cache_;
};

}  // namespace planetree::cache
