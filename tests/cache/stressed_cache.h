#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cache/frame_pool.h"
#include "cache/limbo.h"
#include "cache/protocol.h"
#include "tests/cache/tagged_pages.h"

namespace planetree::cache {

/// A mistake that the writer makes on purpose, to see that it is detected.
enum class WriterMistake : std::uint8_t {
  kNone,
  kReusesAtOnce,    ///< waits for no section
  kForgetsAReader,  ///< waits for the sections of all readers but the last
  kNotesTooEarly,   ///< notes the open sections before it withdraws the page
};

/// The parts of a PageCache, with one writer that only evicts and installs, as fast as it can. A
/// frame that may be reused is first overwritten with words of no page, then with the words of its
/// next page.
///
/// Atomics  as for the classes of the protocol, or with an order weakened
template <class Atomics>
class StressedCache {
 public:
  using Slot = BasicReaderSlot<Atomics>;
  using Map = BasicPageMap<Atomics>;

  static constexpr std::uint32_t kPages = 16, kFrames = 12, kFrameBytes = 128;

  StressedCache(std::uint32_t reader_count, WriterMistake mistake)
      : mistake_(mistake),
        slots_(reader_count),
        stamps_(std::size_t{kFetchers} * slots_waited_for().size()),
        limbo_(slots_waited_for(), entries_, stamps_) {
    for (std::uint32_t frame = 0; frame < kFrames; ++frame) install(frame, frame);
  }

  /// One reader's access: as cache::Reader, without its counts.
  class Reader {
   public:
    Reader(StressedCache& cache, std::uint32_t index)
        : map_(cache.map_), frames_(cache.frames_), slot_(cache.slots_[index]) {}
    void enter() noexcept { slot_.enter(); }
    void leave() noexcept { slot_.leave(); }
    const std::byte* find(std::uint32_t page) noexcept {
      const std::uint32_t frame = map_.find(page);
      return frame == kNoFrame ? nullptr : frames_.frame(frame);
    }

   private:
    const Map map_;
    const FramePool& frames_;
    Slot& slot_;
  };

  /// Installs an absent page if a frame is available. For the writer's thread only.
  bool install_another(Numbers& numbers) {
    const std::uint32_t frame = take_frame(numbers);
    if (frame == kNoFrame) return false;
    std::uint32_t page = numbers.below(kPages);
    while (map_.frame_of(page) != kNoFrame) page = (page + 1) % kPages;
    install(frame, page);
    return true;
  }

 private:
  static constexpr std::uint32_t kFetchers = 4;

  std::span<const Slot> slots_waited_for() const {
    const std::span<const Slot> all(slots_);
    return mistake_ == WriterMistake::kForgetsAReader ? all.first(all.size() - 1) : all;
  }

  // Nothing may come between finding that a frame's sections are over and writing the frame.
  // Reading the state of other sections there would acquire what this check has to acquire.
  std::uint32_t take_frame(Numbers& numbers) {
    for (std::uint32_t fetcher = 0; fetcher < kFetchers; ++fetcher) {
      if (limbo_.holds(fetcher)) continue;
      const std::uint32_t frame = evict(fetcher, numbers);
      if (mistake_ == WriterMistake::kReusesAtOnce) return frame;
    }
    for (std::uint32_t fetcher = 0; fetcher < kFetchers; ++fetcher)
      if (const std::uint32_t frame = limbo_.take(fetcher); frame != kNoFrame) return frame;
    return kNoFrame;
  }

  std::uint32_t evict(std::uint32_t fetcher, Numbers& numbers) {
    const std::uint32_t frame = resident_frame(numbers);
    if (mistake_ == WriterMistake::kNotesTooEarly) limbo_.retire(fetcher, frame);
    map_.withdraw(pages_[frame]);
    pages_[frame] = kNoFrame;
    if (mistake_ != WriterMistake::kNotesTooEarly && mistake_ != WriterMistake::kReusesAtOnce)
      limbo_.retire(fetcher, frame);
    return frame;
  }

  std::uint32_t resident_frame(Numbers& numbers) {
    std::uint32_t frame = numbers.below(kFrames);
    while (pages_[frame] == kNoFrame) frame = (frame + 1) % kFrames;
    return frame;
  }

  void install(std::uint32_t frame, std::uint32_t page) noexcept {
    TaggedPages::write(std::span(frames_.frame(frame), kFrameBytes), page);
    pages_[frame] = page;
    map_.publish(page, frame);
  }

  const WriterMistake mistake_;
  std::vector<Slot> slots_;
  std::vector<typename Map::Cell> cells_ = std::vector<typename Map::Cell>(kPages);
  Map map_{cells_};
  FramePool frames_ = *FramePool::create(kFrames, kFrameBytes);
  // For the writer only.
  std::array<std::uint32_t, kFrames> pages_;
  std::array<typename BasicLimbo<Atomics>::Entry, kFetchers> entries_;
  std::vector<std::uint64_t> stamps_;
  BasicLimbo<Atomics> limbo_;
};

}  // namespace planetree::cache
