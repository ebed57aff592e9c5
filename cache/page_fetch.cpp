// How a PageCache gets pages. Why each fetch ends:
//
// A thread waits outside any section and without the mutex, so it holds up nobody. It waits for
// one of three things. For its own frame in limbo, which no other thread may take and which waits
// only for the sections that were open when it was retired: not for later ones, and those open do
// not depend on us. For a page that another reads or is to read: that ends as disks answer and
// helpers do their work, or at the limit of the terms. For the mutex. So each fetch ends, however
// the others go on, unless a disk stands still; and then those do that need not wait for it.
//
// And it always gets a frame into limbo at once. Each owner keeps at most one frame from others:
// in limbo and waited for, or being filled, or held with the page it waited for. When there are
// fewer frames than pages, pin() leaves at least max_readers + 1 unpinned ones, so that one is
// left beside those of the max_readers other owners. It is free, or resident and can be evicted,
// or in limbo where nobody waits for it, and can be adopted. When there is a frame for each page,
// a page that is absent and not being read means a free frame.
//
// What was waited for is held until it is taken, or two threads might take each other's pages for
// ever, each evicting before the other has woken up.

#include <cassert>
#include <chrono>
#include <thread>

#include "cache/page_cache.h"

namespace planetree::cache {
namespace {

/// Lets others run while a frame is in limbo. Sections last microseconds, so
/// first only yield; but yielding does not let a thread of lower priority run,
/// and the section waited for may be that thread's: so sleep if it lasts.
void wait_for_sections(std::uint32_t attempt) noexcept {
  constexpr std::uint32_t kYields = 64;
  if (attempt < kYields) {
    std::this_thread::yield();
  } else {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

}  // namespace

Fetched PageCache::fetch(ReaderSlot& slot, std::uint32_t page, const FetchTerms& terms) noexcept {
  assert(page < limits_.page_count);
  const auto fetcher = static_cast<std::uint32_t>(&slot - tables_.slots.data());
  Lock lock(mutex_);
  const Outcome outcome = make_resident(lock, fetcher, page, terms, nullptr);
  // Entering before the mutex is free: whoever evicts this page later
  // has the mutex after us, sees us inside, and leaves its frame alone.
  slot.enter();
  if (outcome == Outcome::kResident) return {frames_.frame(map_.frame_of(page))};
  return {nullptr, outcome == Outcome::kGivenUp};
}

bool PageCache::help(std::uint32_t fetcher) noexcept {
  Lock lock(mutex_);
  for (std::uint32_t attempt = 0;; ++attempt) {
    limbo_.set_awaited(fetcher, false);
    const std::uint32_t page = in_flight_reads_.page_wanted();
    if (page == InFlightReads::kNobody) return false;
    const std::uint32_t frame = take_frame(lock, fetcher, attempt);
    if (frame == kNoFrame) continue;
    read_page(lock, fetcher, page, frame, true, nullptr);
    return true;
  }
}

PageCache::Outcome PageCache::make_resident(Lock& lock, std::uint32_t fetcher, std::uint32_t page,
                                            const FetchTerms& terms, Error* why) noexcept {
  bool would_block = false;
  for (std::uint32_t attempt = 0;; ++attempt) {
    limbo_.set_awaited(fetcher, false);
    // Another thread may have brought the page meanwhile.
    if (const std::uint32_t frame = map_.frame_of(page); frame != kNoFrame) {
      policy_.marks().mark(frame);
      return Outcome::kResident;
    }
    if (quarantined(page)) return Outcome::kUnreadable;
    Outcome outcome;
    if (would_block || in_flight_reads_.is_read(page)) {
      outcome = wait_for_page(lock, fetcher, page, terms);
    } else {
      const std::uint32_t frame = take_frame(lock, fetcher, attempt);
      if (frame == kNoFrame) continue;
      outcome = read_page(lock, fetcher, page, frame, terms.reads_itself, why);
    }
    if (outcome == Outcome::kWouldWait)
      would_block = true;
    else if (outcome != Outcome::kRetry)
      return outcome;
  }
}

PageCache::Outcome PageCache::read_page(Lock& lock, std::uint32_t fetcher, std::uint32_t page,
                                        std::uint32_t frame, bool may_wait, Error* why) noexcept {
  const auto wake_waiting = [this](std::uint32_t waiting) { wake(waiting); };
  in_flight_reads_.read(fetcher, page);
  lock.unlock();
  const Result<Filled> filled =
      fill_(context_, {page, fetcher, may_wait, {frames_.frame(frame), limits_.frame_bytes}});
  lock.lock();
  in_flight_reads_.end(fetcher);
  if (!filled) {
    tables_.free_frames[free_count_++] = frame;
    quarantine(page);
    in_flight_reads_.fail(page, wake_waiting);
    if (why != nullptr) *why = filled.error();
    return Outcome::kUnreadable;
  }
  if (*filled == Filled::kWouldWait) {
    assert(!may_wait);
    tables_.free_frames[free_count_++] = frame;
    in_flight_reads_.put_back(page, wake_waiting);
    return Outcome::kWouldWait;
  }
  tables_.pages[frame] = page;
  policy_.install(frame, *filled == Filled::kFilledUpper ? PageTier::kUpper : PageTier::kLower);
  map_.publish(page, frame);
  add_one(counts_.fills);
  if (in_flight_reads_.serve(page, frame, wake_waiting) > 0) policy_.hold(frame);
  return Outcome::kResident;
}

PageCache::Outcome PageCache::wait_for_page(Lock& lock, std::uint32_t fetcher, std::uint32_t page,
                                            const FetchTerms& terms) noexcept {
  in_flight_reads_.wait(fetcher, page, terms.reads_itself);
  const auto waits = [this, fetcher] {
    const InFlightRead::Stage stage = in_flight_reads_.of(fetcher).stage;
    return stage == InFlightRead::Stage::kWaits || stage == InFlightRead::Stage::kWanted;
  };
  if (in_flight_reads_.of(fetcher).stage == InFlightRead::Stage::kWanted)
    helpers_waker_.notify_one();
  std::condition_variable& waker = wakers_[fetcher % kWakers];
  const auto is_done = [&waits] { return !waits(); };
  if (terms.wait_limit == FetchTerms::kNoLimit) {
    waker.wait(lock, is_done);
  } else {
    waker.wait_for(lock, terms.wait_limit, is_done);
  }
  const InFlightRead in_flight = in_flight_reads_.of(fetcher);
  in_flight_reads_.end(fetcher);
  switch (in_flight.stage) {
    case InFlightRead::Stage::kServed:
      if (!in_flight_reads_.holds(in_flight.frame)) policy_.release(in_flight.frame);
      return Outcome::kResident;
    case InFlightRead::Stage::kFailed:
      return Outcome::kUnreadable;
    case InFlightRead::Stage::kRetry:
      return Outcome::kRetry;
    default:
      add_one(counts_.given_up);
      return Outcome::kGivenUp;
  }
}

void PageCache::wait_for_read(std::chrono::microseconds most,
                              const std::atomic<bool>& stop) noexcept {
  Lock lock(mutex_);
  helpers_waker_.wait_for(lock, most, [&] {
    return stop.load(std::memory_order_relaxed) ||
           in_flight_reads_.page_wanted() != InFlightReads::kNobody;
  });
}

void PageCache::wake_helpers() noexcept {
  // Whoever has looked at `stop` waits by now.
  { const Lock lock(mutex_); }
  helpers_waker_.notify_all();
}

std::uint32_t PageCache::take_frame(Lock& lock, std::uint32_t fetcher,
                                    std::uint32_t attempt) noexcept {
  const std::uint32_t frame = try_to_take_frame(fetcher);
  if (frame != kNoFrame) return frame;
  limbo_.set_awaited(fetcher, true);
  lock.unlock();
  wait_for_sections(attempt);
  lock.lock();
  return kNoFrame;
}

std::uint32_t PageCache::try_to_take_frame(std::uint32_t fetcher) noexcept {
  if (free_count_ > 0) return tables_.free_frames[--free_count_];
  if (const std::uint32_t frame = limbo_.take(fetcher); frame != kNoFrame) return frame;
  if (const std::uint32_t frame = limbo_.take_unawaited(); frame != kNoFrame) return frame;
  if (limbo_.holds(fetcher)) return kNoFrame;
  if (!evict_into_limbo(fetcher)) limbo_.adopt(fetcher);
  assert(limbo_.holds(fetcher));
  // At once, if no section was open.
  return limbo_.take(fetcher);
}

bool PageCache::evict_into_limbo(std::uint32_t fetcher) noexcept {
  const std::uint32_t frame = policy_.choose_victim();
  if (frame == kNoFrame) return false;
  policy_.remove(frame);
  // Withdrawing comes before noting the open sections: E2, then E3.
  map_.withdraw(tables_.pages[frame]);
  limbo_.retire(fetcher, frame);
  add_one(counts_.evictions);
  return true;
}

}  // namespace planetree::cache
