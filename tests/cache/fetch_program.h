#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cache/in_flight_reads.h"
#include "tests/cache/explored_cache.h"
#include "tests/cache/explorer/program.h"

namespace planetree::cache {

/// Size of a FetchProgram, and mistakes to make on purpose.
struct Fetching {
  std::uint32_t threads = 2;
  std::uint32_t fetches = 1;          ///< fetches of each thread
  bool same_page = false;             ///< all begin with the absent page
  bool enters_too_late = false;       ///< begins the section after releasing the mutex
  bool does_not_hold_frames = false;  ///< evicts frames whose page a thread still waits for
};

/// Threads that fetch the pages they miss. As in PageCache::fetch(), the thread that holds the
/// mutex is the writer; frames are filled without the mutex, and a thread that needs a page which
/// another reads waits for that read. There is one frame more than threads and one page more than
/// frames, so threads evict each other's pages.
class FetchProgram final : public explorer::Program {
 public:
  explicit FetchProgram(const Fetching& fetching)
      : fetching_(fetching),
        cache_(fetching.threads, fetching.threads + 1, fetching.threads + 2, fetching.threads),
        table_(fetching.threads),
        in_flight_reads_(table_) {}

  std::uint32_t thread_count() const noexcept override { return fetching_.threads; }

  void run(std::uint32_t thread) override {
    const std::uint32_t page_count = fetching_.threads + 2;
    ExploredCache::Slot& slot = cache_.slot(thread);
    // The first thread begins with the absent page. The next begins with the page that is evicted
    // for it, or with the same page.
    std::uint32_t page = (page_count - 1 + (fetching_.same_page ? 0 : thread)) % page_count;
    for (std::uint32_t i = 0; i < fetching_.fetches; ++i, page = (page + 1) % page_count) {
      slot.enter();
      std::uint32_t frame = cache_.map().find(page);
      if (frame == kNoFrame) {
        slot.leave();
        frame = fetch(thread, page);
        if (frame == kNoFrame) return;
      }
      cache_.read(frame, page);
      slot.leave();
    }
  }

 private:
  static constexpr std::uint32_t kTries = 2;

  std::uint32_t fetch(std::uint32_t thread, std::uint32_t page) {
    for (std::uint32_t i = 0; i < kTries; ++i) {
      mutex_.lock();
      const std::uint32_t frame = make_resident(thread, page);
      if (frame != kNoFrame && !fetching_.enters_too_late) cache_.slot(thread).enter();
      mutex_.unlock();
      if (frame != kNoFrame && fetching_.enters_too_late) cache_.slot(thread).enter();
      if (frame != kNoFrame) return frame;
      explorer::Execution::current().yield();
    }
    mutex_.lock();
    in_flight_reads_.end(thread);
    mutex_.unlock();
    return kNoFrame;
  }

  std::uint32_t make_resident(std::uint32_t fetcher, std::uint32_t page) {
    cache_.limbo().set_awaited(fetcher, false);
    const InFlightRead in_flight = in_flight_reads_.of(fetcher);
    if (in_flight.stage == InFlightRead::Stage::kWaits) return kNoFrame;
    in_flight_reads_.end(fetcher);
    if (in_flight.stage == InFlightRead::Stage::kServed) return in_flight.frame;
    if (const std::uint32_t frame = cache_.map().frame_of(page); frame != kNoFrame) return frame;
    if (in_flight_reads_.is_being_read(page)) {
      in_flight_reads_.wait(fetcher, page, true);
      return kNoFrame;
    }
    const std::uint32_t frame = take_frame(fetcher);
    if (frame == kNoFrame) {
      cache_.limbo().set_awaited(fetcher, true);
    } else {
      read(fetcher, page, frame);
    }
    return frame;
  }

  void read(std::uint32_t fetcher, std::uint32_t page, std::uint32_t frame) {
    in_flight_reads_.read(fetcher, page);
    mutex_.unlock();
    cache_.fill(frame, page);
    mutex_.lock();
    in_flight_reads_.end(fetcher);
    cache_.map().publish(page, frame);
    in_flight_reads_.serve(page, frame, [](std::uint32_t) {});
  }

  std::uint32_t take_frame(std::uint32_t fetcher) {
    ExploredCache::Limbo& limbo = cache_.limbo();
    if (const std::uint32_t frame = limbo.take(fetcher); frame != kNoFrame) return frame;
    if (const std::uint32_t frame = limbo.take_unawaited(); frame != kNoFrame) return frame;
    if (limbo.holds(fetcher)) return kNoFrame;
    const std::uint32_t victim = choose_victim();
    if (victim != kNoFrame) {
      cache_.map().withdraw(cache_.page_in(victim));
      limbo.retire(fetcher, victim);
    } else if (!limbo.adopt(fetcher)) {
      explorer::Execution::current().fail("no frame, not even in limbo");
      return kNoFrame;
    }
    return limbo.take(fetcher);
  }

  /// Any resident frame that no thread waits for: correctness must not depend on what CLOCK
  /// prefers.
  std::uint32_t choose_victim() {
    std::array<std::uint32_t, explorer::kMaxThreads + 1> resident;
    std::uint32_t count = 0;
    for (std::uint32_t frame = 0; frame <= fetching_.threads; ++frame) {
      if (in_flight_reads_.holds(frame) && !fetching_.does_not_hold_frames) continue;
      if (cache_.map().frame_of(cache_.page_in(frame)) == frame) resident[count++] = frame;
    }
    if (count == 0) return kNoFrame;
    return resident[explorer::Execution::current().choose(count)];
  }

  const Fetching fetching_;
  ExploredCache cache_;
  std::vector<InFlightRead> table_;
  InFlightReads in_flight_reads_;
  explorer::Mutex mutex_;
};

}  // namespace planetree::cache
