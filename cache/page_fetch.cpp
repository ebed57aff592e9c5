// How a PageCache fetches pages, and why each fetch ends.
//
// A fetcher waits outside of its section and without the mutex, so it delays no other thread. It
// waits for one of three things:
//
// - Its own frame in limbo. No other fetcher may take an awaited frame. The frame waits only for
//   the sections that were open when it was retired, and these do not depend on this fetcher.
// - A page that another fetcher reads or is to read. This wait ends when the disk answers and the
//   helpers have done their work, or at the wait limit of the FetchTerms.
// - The mutex.
//
// So each fetch ends, whatever other threads do, as long as the disk answers. If the disk does not
// answer, the fetches that do not need it still end.
//
// A fetcher never has to wait for a frame to put into limbo. Each fetcher withholds at most one
// frame from the others: one that it awaits in limbo, one that it fills, or one that is held with
// the page it waited for. If there are fewer frames than pages, pin() leaves at least
// max_readers + 1 frames unpinned, so at least one remains beside those of the max_readers other
// fetchers. That frame is free, or resident and can be evicted, or in limbo without being awaited
// and can be adopted. If there is a frame for each page, a page that is absent and not being read
// leaves a frame free.
//
// A page that was waited for is held until it is taken. Otherwise two threads could evict each
// other's pages without end, each before the other has woken up.

#include <algorithm>
#include <cassert>
#include <chrono>
#include <thread>

#include "cache/page_cache.h"

namespace planetree::cache {
namespace {

/// Lets other threads run while a frame is in limbo. Sections last microseconds, so yielding
/// usually suffices. But it does not let a thread of lower priority run, and the section waited
/// for may belong to one, so later attempts sleep.
void wait_for_sections(std::uint32_t attempt) noexcept {
  constexpr std::uint32_t kYields = 64;
  if (attempt < kYields) {
    std::this_thread::yield();
  } else {
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

}  // namespace

FetchResult Reader::fetch(std::uint32_t page, const FetchTerms& terms) noexcept {
  slot_->leave();
  return cache_->fetch(*slot_, first_page_ + page, terms);
}

bool Reader::help() noexcept {
  assert(!inside());
  return cache_->help(index_);
}

FetchResult PageCache::fetch(ReaderSlot& slot, std::uint32_t page,
                             const FetchTerms& terms) noexcept {
  assert(page < limits_.page_count);
  const auto fetcher = static_cast<std::uint32_t>(&slot - tables_.slots.data());
  Lock lock(mutex_);
  const Outcome outcome = make_resident(lock, fetcher, page, terms, nullptr);
  // The section begins before the mutex is released. A thread that evicts this page later takes
  // the mutex after us, so it sees this section open and does not reuse the frame.
  slot.enter();
  if (outcome == Outcome::kResident) return {frames_.frame(map_.frame_of(page))};
  return {nullptr, outcome == Outcome::kGivenUp};
}

bool PageCache::help(std::uint32_t fetcher) noexcept {
  Lock lock(mutex_);
  for (std::uint32_t attempt = 0;; ++attempt) {
    limbo_.set_awaited(fetcher, false);
    const std::uint32_t page = in_flight_reads_.next_wanted_page();
    if (page == InFlightReads::kNoPage) return false;
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
    // Another fetcher may have made the page resident in the meantime.
    if (const std::uint32_t frame = map_.frame_of(page); frame != kNoFrame) {
      evictor_.reference_bits().mark(frame);
      return Outcome::kResident;
    }
    if (quarantined(page)) return Outcome::kUnreadable;
    Outcome outcome;
    if (would_block || in_flight_reads_.is_being_read(page)) {
      outcome = wait_for_page(lock, fetcher, page, terms);
    } else {
      const std::uint32_t frame = take_frame(lock, fetcher, attempt);
      if (frame == kNoFrame) continue;
      outcome = read_page(lock, fetcher, page, frame, terms.reads_itself, why);
    }
    if (outcome == Outcome::kWouldBlock)
      would_block = true;
    else if (outcome != Outcome::kRetry)
      return outcome;
  }
}

PageCache::Outcome PageCache::read_page(Lock& lock, std::uint32_t fetcher, std::uint32_t page,
                                        std::uint32_t frame, bool may_block, Error* why) noexcept {
  const auto wake_waiting = [this](std::uint32_t waiting) { wake(waiting); };
  in_flight_reads_.read(fetcher, page);
  lock.unlock();
  const Result<FillResult> filled =
      fill_(context_, {page, fetcher, may_block, {frames_.frame(frame), limits_.frame_bytes}});
  lock.lock();
  in_flight_reads_.end(fetcher);
  if (!filled) {
    tables_.free_frames[free_count_++] = frame;
    quarantine(page);
    in_flight_reads_.fail(page, wake_waiting);
    if (why != nullptr) *why = filled.error();
    return Outcome::kUnreadable;
  }
  if (*filled == FillResult::kWouldBlock) {
    assert(!may_block);
    tables_.free_frames[free_count_++] = frame;
    in_flight_reads_.abandon(page, wake_waiting);
    return Outcome::kWouldBlock;
  }
  if (*filled == FillResult::kLate) {
    tables_.free_frames[free_count_++] = frame;
    in_flight_reads_.give_up(page, wake_waiting);
    add_one(counts_.given_up);
    if (why != nullptr)
      *why = make_error(ErrorCode::kReadFailed, page, Error::kNowhere,
                        "page %u cannot be read now: try again later", page);
    return Outcome::kGivenUp;
  }
  tables_.pages[frame] = page;
  const PageTier tier = *filled == FillResult::kFilledUpper ? PageTier::kUpper : PageTier::kLower;
  evictor_.install(frame, page, tier);
  if (observer_.on_install) observer_.on_install(observer_.context, fetcher, page, tier);
  map_.publish(page, frame);
  add_one(counts_.fills);
  if (in_flight_reads_.serve(page, frame, wake_waiting) > 0) evictor_.hold(frame);
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
  using Clock = std::chrono::steady_clock;
  const bool has_limit = terms.wait_limit != FetchTerms::kNoLimit;
  const Clock::time_point end =
      has_limit ? std::min(Clock::now() + terms.wait_limit, terms.deadline) : terms.deadline;
  if (end == Clock::time_point::max()) {
    waker.wait(lock, is_done);
  } else {
    waker.wait_until(lock, end, is_done);
  }
  const InFlightRead in_flight = in_flight_reads_.of(fetcher);
  in_flight_reads_.end(fetcher);
  switch (in_flight.stage) {
    case InFlightRead::Stage::kServed:
      if (!in_flight_reads_.holds(in_flight.frame)) evictor_.release(in_flight.frame);
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

void PageCache::wait_for_wanted_page(std::chrono::microseconds max_wait,
                                     const std::atomic<bool>& stop) noexcept {
  Lock lock(mutex_);
  helpers_waker_.wait_for(lock, max_wait, [&] {
    return stop.load(std::memory_order_relaxed) ||
           in_flight_reads_.next_wanted_page() != InFlightReads::kNoPage;
  });
}

void PageCache::wake_helpers() noexcept {
  // A helper that has read `stop` as false holds the mutex until it waits. Taking the mutex once
  // makes sure that it does not miss the notification.
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
  // If no section was open when the frame was retired, it can be taken at once.
  return limbo_.take(fetcher);
}

bool PageCache::evict_into_limbo(std::uint32_t fetcher) noexcept {
  const std::uint32_t frame = evictor_.choose_victim();
  if (frame == kNoFrame) return false;
  evictor_.remove(frame);
  // The page must be withdrawn before the open sections are noted: E2, then E3.
  map_.withdraw(tables_.pages[frame]);
  if (observer_.on_evict) observer_.on_evict(observer_.context, fetcher, tables_.pages[frame]);
  limbo_.retire(fetcher, frame);
  add_one(counts_.evictions);
  return true;
}

}  // namespace planetree::cache
