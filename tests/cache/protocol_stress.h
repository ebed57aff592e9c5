#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

#include "cache/page_cache.h"
#include "cache/protocol.h"
#include "tests/cache/stressed_cache.h"
#include "tests/cache/tagged_pages.h"

/// Readers and a writer at full speed on real threads, while the explorer runs small programs.
/// Every word that a reader reads must be of the requested page. The same run under a thread
/// sanitizer also checks for data races.
namespace planetree::cache {

struct StressGoal {
  std::uint32_t readers = 2;
  std::uint64_t queries = 0;   ///< minimum, over all readers together
  std::uint64_t installs = 0;  ///< minimum
  /// Ends at the first wrong word, for runs that must find one.
  bool until_wrong = false;
};

/// Counts of a run.
struct StressCount {
  std::uint64_t queries = 0;  ///< sections, of up to kLookups pages
  std::uint64_t found = 0;    ///< pages found; each is read again at the end of its section
  std::uint64_t wrong = 0;    ///< pages with a word of another page or of none
  std::uint64_t installs = 0;
};

/// Progress of a run. Relaxed, because it must not provide ordering that the protocol has to
/// provide.
class StressProgress {
 public:
  explicit StressProgress(const StressGoal& goal) : goal_(goal) {}

  bool is_over() const noexcept {
    if (goal_.until_wrong && wrong_.load(std::memory_order_relaxed) > 0) return true;
    return queries_.load(std::memory_order_relaxed) >= goal_.queries &&
           installs_.load(std::memory_order_relaxed) >= goal_.installs;
  }
  void count_queries(std::uint64_t queries, bool wrong) noexcept {
    queries_.fetch_add(queries, std::memory_order_relaxed);
    if (wrong) wrong_.store(1, std::memory_order_relaxed);
  }
  void count_installs(std::uint64_t installs) noexcept {
    installs_.fetch_add(installs, std::memory_order_relaxed);
  }

 private:
  const StressGoal goal_;
  std::atomic<std::uint64_t> queries_{0}, installs_{0}, wrong_{0};
};

/// The loop of one reader.
template <class Reader>
class StressReading {
 public:
  StressReading(Reader& reader, std::uint32_t page_count, std::uint32_t frame_bytes,
                std::uint64_t seed)
      : reader_(reader), page_count_(page_count), frame_bytes_(frame_bytes), numbers_(seed) {}

  StressCount run(StressProgress& progress) {
    constexpr std::uint32_t kQueriesAtOnce = 256;
    while (!progress.is_over()) {
      for (std::uint32_t i = 0; i < kQueriesAtOnce; ++i) read_all();
      count_.queries += kQueriesAtOnce;
      progress.count_queries(kQueriesAtOnce, count_.wrong > 0);
      // Lets the writer see it outside a section too, on few cores.
      if (numbers_.below(4) == 0) std::this_thread::yield();
    }
    return count_;
  }

 private:
  static constexpr std::uint32_t kLookups = 4;

  void read_all() {
    std::array<const std::byte*, kLookups> frames;
    std::array<std::uint32_t, kLookups> pages;
    std::uint32_t kept = 0;
    reader_.enter();
    for (std::uint32_t i = 0; i < kLookups; ++i) {
      pages[kept] = numbers_.below(page_count_);
      frames[kept] = reader_.find(pages[kept]);
      if (frames[kept] == nullptr) continue;
      check(frames[kept], pages[kept]);
      ++kept;
    }
    // Lets the writer run during the section, on few cores too.
    if (numbers_.below(1024) == 0) std::this_thread::yield();
    for (std::uint32_t i = 0; i < kept; ++i) check(frames[i], pages[i]);
    reader_.leave();
    count_.found += kept;
  }

  void check(const std::byte* frame, std::uint32_t page) {
    count_.wrong += !TaggedPages::matches(frame, frame_bytes_, page);
  }

  Reader& reader_;
  const std::uint32_t page_count_, frame_bytes_;
  Numbers numbers_;
  StressCount count_;
};

/// Runs `install` beside readers until the goal is reached. `install` returns whether it installed
/// a page.
///
/// read  runs one reader; its arguments are the reader's index and the progress.
inline StressCount run_stress(
    const StressGoal& goal, const std::function<bool()>& install,
    const std::function<StressCount(std::uint32_t, StressProgress&)>& read) {
  StressProgress progress(goal);
  std::vector<StressCount> counts(goal.readers);
  std::vector<std::thread> threads;
  for (std::uint32_t index = 0; index < goal.readers; ++index)
    threads.emplace_back([&, index] { counts[index] = read(index, progress); });
  StressCount sum;
  while (!progress.is_over()) {
    const bool installed = install();
    sum.installs += installed;
    progress.count_installs(installed);
    if (!installed) std::this_thread::yield();
  }
  for (std::thread& thread : threads) thread.join();
  for (const StressCount& count : counts) {
    sum.queries += count.queries;
    sum.found += count.found;
    sum.wrong += count.wrong;
  }
  return sum;
}

/// Stresses the classes of the protocol alone.
template <class Atomics = StdAtomics>
StressCount stress_protocol(const StressGoal& goal, WriterMistake mistake = WriterMistake::kNone) {
  using Cache = StressedCache<Atomics>;
  Cache cache(goal.readers, mistake);
  Numbers numbers(99);
  return run_stress(
      goal, [&] { return cache.install_another(numbers); },
      [&](std::uint32_t index, StressProgress& progress) {
        typename Cache::Reader reader(cache, index);
        return StressReading(reader, Cache::kPages, Cache::kFrameBytes, index + 1).run(progress);
      });
}

/// Stresses a whole PageCache; the installing thread is one that fetches.
inline StressCount stress_page_cache(const StressGoal& goal) {
  // This many frames fill whole system pages, so a budget can give an exact number of them.
  constexpr std::uint32_t kStressPages = 64, kStressFrames = 32, kStressFrameBytes = 128;
  TaggedPages pages;
  auto cache = PageCache::create(
      limits_for_frames(kStressFrames, kStressPages, goal.readers + 1, kStressFrameBytes),
      TaggedPages::fill, &pages);
  Reader writer = *(*cache)->claim_reader();
  Numbers numbers(99);
  const auto install = [&] {
    const std::uint64_t before = pages.fill_calls();
    writer.enter();
    writer.fetch(numbers.below(kStressPages));
    writer.leave();
    return pages.fill_calls() > before;
  };
  return run_stress(goal, install, [&](std::uint32_t index, StressProgress& progress) {
    Reader reader = *(*cache)->claim_reader();
    return StressReading(reader, kStressPages, kStressFrameBytes, index + 1).run(progress);
  });
}

}  // namespace planetree::cache
