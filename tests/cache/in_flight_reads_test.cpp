// Concurrent fetches: each page is read once, outside the mutex, and stays until the threads that
// wait for it have taken it.

#include "cache/in_flight_reads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>
#include <vector>

#include "cache/page_cache.h"
#include "tests/cache/tagged_pages.h"

namespace planetree::cache {
namespace {

constexpr std::uint32_t kReadFrameBytes = 4096;

TEST(InFlightReads, ServesAllThreadsThatWaitForAPage) {
  std::vector<InFlightRead> table(4);
  InFlightReads in_flight_reads(table);
  in_flight_reads.read(0, 7);
  EXPECT_TRUE(in_flight_reads.is_being_read(7));
  in_flight_reads.wait(1, 7, false);
  in_flight_reads.wait(2, 7, true);
  in_flight_reads.wait(3, 8, false);
  EXPECT_EQ(in_flight_reads.next_wanted_page(), 8u);
  std::set<std::uint32_t> woken;
  const auto wake = [&](std::uint32_t fetcher) { woken.insert(fetcher); };
  in_flight_reads.end(0);
  EXPECT_EQ(in_flight_reads.serve(7, 5, wake), 2u);
  EXPECT_EQ(woken, (std::set<std::uint32_t>{1, 2}));
  in_flight_reads.end(1);
  EXPECT_TRUE(in_flight_reads.holds(5));
  in_flight_reads.end(2);
  EXPECT_FALSE(in_flight_reads.holds(5));
}

TEST(InFlightReads, FirstWantedPageIsTheLongestAwaited) {
  std::vector<InFlightRead> table(4);
  InFlightReads in_flight_reads(table);
  EXPECT_EQ(in_flight_reads.next_wanted_page(), InFlightReads::kNoPage);
  in_flight_reads.wait(3, 8, false);
  in_flight_reads.wait(0, 9, false);
  in_flight_reads.wait(1, 8, false);
  EXPECT_EQ(in_flight_reads.next_wanted_page(), 8u);
  in_flight_reads.read(2, 8);
  EXPECT_EQ(in_flight_reads.next_wanted_page(), 9u);
  in_flight_reads.end(0);
  EXPECT_EQ(in_flight_reads.next_wanted_page(), InFlightReads::kNoPage);
}

TEST(InFlightReads, PutBackWakesOnlyThreadsThatReadForThemselves) {
  std::vector<InFlightRead> table(3);
  InFlightReads in_flight_reads(table);
  in_flight_reads.read(0, 7);
  in_flight_reads.wait(1, 7, true);
  in_flight_reads.wait(2, 7, false);
  EXPECT_EQ(in_flight_reads.next_wanted_page(), InFlightReads::kNoPage);
  in_flight_reads.end(0);
  std::set<std::uint32_t> woken;
  in_flight_reads.abandon(7, [&](std::uint32_t fetcher) { woken.insert(fetcher); });
  EXPECT_EQ(woken, std::set<std::uint32_t>{1});
  EXPECT_EQ(in_flight_reads.of(1).stage, InFlightRead::Stage::kRetry);
  EXPECT_EQ(in_flight_reads.next_wanted_page(), 7u);
}

/// Pages, some of which are slow: a read of them stalls until released, and would block for threads
/// that may not wait.
struct SlowPages {
  TaggedPages tags;
  std::set<std::uint32_t> slow;
  std::atomic<bool> released{false};
  std::atomic<bool> is_late{false};  ///< slow pages do not come at all
  std::atomic<int> stalled{0};
  std::atomic<int> refused{0};

  static Result<FillResult> fill(void* context, const FillRequest& request) {
    auto& pages = *static_cast<SlowPages*>(context);
    if (pages.slow.contains(request.page)) {
      if (!request.may_block) {
        ++pages.refused;
        return FillResult::kWouldBlock;
      }
      ++pages.stalled;
      while (!pages.released) std::this_thread::yield();
      --pages.stalled;
      if (pages.is_late) return FillResult::kLate;
    }
    return TaggedPages::fill(&pages.tags, request);
  }
};

class ConcurrentFetches : public testing::Test {
 protected:
  void open(std::uint32_t frames) {
    auto cache = PageCache::create(limits_for_frames(frames, 50, 4), SlowPages::fill, &pages_);
    ASSERT_TRUE(cache);
    cache_ = *std::move(cache);
  }

  /// Starts a thread that fetches a page and checks its frame.
  std::thread fetching(std::uint32_t page, const FetchTerms& terms = {}) {
    return std::thread([this, page, terms] {
      Reader reader = *cache_->claim_reader();
      reader.enter();
      const FetchResult fetched = reader.fetch(page, terms);
      if (fetched.given_up) ++given_up_;
      if (fetched.frame && TaggedPages::matches(fetched.frame, kReadFrameBytes, page)) ++right_;
      reader.leave();
    });
  }

  /// Starts such a thread and waits until its read stalls.
  std::thread start_stalled(std::uint32_t page) {
    std::thread thread = fetching(page);
    while (pages_.stalled == 0) std::this_thread::yield();
    return thread;
  }

  SlowPages pages_;
  std::unique_ptr<PageCache> cache_;
  std::atomic<int> right_{0}, given_up_{0};
};

constexpr FetchTerms kByHelpers{.reads_itself = false};
constexpr FetchTerms kAtOnceOrNot{.reads_itself = false,
                                  .wait_limit = std::chrono::milliseconds(1)};

TEST_F(ConcurrentFetches, TwoFetchesOfOnePageReadItOnce) {
  open(6);
  pages_.slow = {7};
  std::thread first = start_stalled(7);
  std::thread second = fetching(7);
  pages_.released = true;
  first.join();
  second.join();
  EXPECT_EQ(right_, 2);
  EXPECT_EQ(pages_.tags.fill_calls(), 1u);
}

TEST_F(ConcurrentFetches, ALatePageIsGivenUpByAllAndComesLater) {
  open(6);
  pages_.slow = {7};
  pages_.is_late = true;
  std::thread first = start_stalled(7);
  std::thread second = fetching(7);
  std::thread third = fetching(7, kByHelpers);
  pages_.released = true;
  first.join();
  second.join();
  // A thread that does not read itself waits for a helper, whose read fails too.
  Reader helper = *cache_->claim_reader();
  while (given_up_ < 3) helper.help();
  third.join();
  EXPECT_EQ(right_, 0);
  EXPECT_EQ(cache_->stats().quarantined, 0u);
  EXPECT_GE(cache_->stats().given_up, 3u);
  pages_.is_late = false;
  fetching(7).join();
  EXPECT_EQ(right_, 1);
}

TEST_F(ConcurrentFetches, ALatePageCannotBePinned) {
  open(6);
  pages_.slow = {7};
  pages_.released = pages_.is_late = true;
  const auto pinned = cache_->pin(7);
  ASSERT_FALSE(pinned);
  EXPECT_EQ(pinned.error().code, ErrorCode::kReadFailed);
  pages_.is_late = false;
  EXPECT_TRUE(cache_->pin(7));
}

TEST_F(ConcurrentFetches, OtherFetchesProceedWhileOneReadStalls) {
  open(6);
  pages_.slow = {7};
  std::thread stuck = start_stalled(7);
  // This is the smallest cache, so pages are evicted meanwhile.
  for (std::uint32_t page = 8; page < 50; ++page) fetching(page).join();
  EXPECT_EQ(right_, 42);
  EXPECT_EQ(pages_.stalled, 1);
  pages_.released = true;
  stuck.join();
  EXPECT_EQ(right_, 43);
}

TEST_F(ConcurrentFetches, HelpersReadPagesThatWouldBlock) {
  open(6);
  pages_.slow = {7, 8};
  pages_.released = true;
  Reader helper = *cache_->claim_reader();
  EXPECT_FALSE(helper.help());
  std::thread first = fetching(7, kByHelpers), second = fetching(8, kByHelpers);
  for (int helped = 0; helped < 2;) helped += helper.help();
  first.join();
  second.join();
  EXPECT_EQ(right_, 2);
  EXPECT_EQ(pages_.refused, 2);
  EXPECT_FALSE(helper.help());
}

TEST_F(ConcurrentFetches, ReadsThatDoNotBlockNeedNoHelper) {
  open(6);
  for (std::uint32_t page = 0; page < 20; ++page) fetching(page, kByHelpers).join();
  EXPECT_EQ(right_, 20);
}

TEST_F(ConcurrentFetches, GivesUpAtTheWaitLimit) {
  open(6);
  pages_.slow = {7};
  fetching(7, kAtOnceOrNot).join();
  EXPECT_EQ(given_up_, 1);
  EXPECT_EQ(cache_->stats().given_up, 1u);
  EXPECT_EQ(cache_->stats().quarantined, 0u);
  // No thread waits any more.
  Reader helper = *cache_->claim_reader();
  EXPECT_FALSE(helper.help());
  pages_.released = true;
  fetching(7).join();
  EXPECT_EQ(right_, 1);
}

TEST_F(ConcurrentFetches, FetchContinuesAfterAnotherGaveUp) {
  open(6);
  pages_.slow = {7};
  std::thread stuck = start_stalled(7);
  std::thread patient = fetching(7), hasty = fetching(7, kAtOnceOrNot);
  hasty.join();
  EXPECT_EQ(given_up_, 1);
  pages_.released = true;
  stuck.join();
  patient.join();
  EXPECT_EQ(right_, 2);
  EXPECT_EQ(pages_.tags.fill_calls(), 1u);
}

TEST_F(ConcurrentFetches, UnreadablePageFailsAllThreadsThatWait) {
  open(6);
  pages_.slow = {7};
  pages_.tags.make_unreadable(7);
  std::thread first = start_stalled(7);
  std::thread second = fetching(7), third = fetching(7, kByHelpers);
  pages_.released = true;
  first.join();
  second.join();
  third.join();
  EXPECT_EQ(right_ + given_up_, 0);
  EXPECT_EQ(cache_->stats().quarantined, 1u);
  EXPECT_EQ(pages_.tags.fill_calls(), 1u);
}

// The smallest cache, with fetches that rely on helpers and fetches that read for themselves.
TEST_F(ConcurrentFetches, EveryFetchEndsInTheSmallestCache) {
  open(6);
  for (std::uint32_t page = 0; page < 50; page += 3) pages_.slow.insert(page);
  pages_.released = true;
  std::atomic<bool> stop{false};
  std::atomic<int> wrong{0};
  std::thread helper([&] {
    Reader reader = *cache_->claim_reader();
    while (!stop) {
      cache_->wait_for_wanted_page(std::chrono::microseconds(100), stop);
      reader.help();
    }
  });
  std::vector<std::thread> queriers;
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    queriers.emplace_back([&, seed] {
      Reader reader = *cache_->claim_reader();
      Numbers numbers(seed);
      for (int i = 0; i < 3000; ++i) {
        reader.enter();
        // Few pages, so that many threads need the same.
        const std::uint32_t page = numbers.below(12);
        const FetchResult fetched = reader.fetch(page, seed == 3 ? FetchTerms{} : kByHelpers);
        wrong += !fetched.frame || !TaggedPages::matches(fetched.frame, kReadFrameBytes, page);
        reader.leave();
      }
    });
  for (std::thread& querier : queriers) querier.join();
  stop = true;
  cache_->wake_helpers();
  helper.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(cache_->stats().evictions, 100u);
}

}  // namespace
}  // namespace planetree::cache
