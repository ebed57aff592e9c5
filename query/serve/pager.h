#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "cache/page_cache.h"
#include "planetree/error.h"
#include "planetree/model.h"
#include "query/serve/query_arena.h"
#include "storage/file/page_file.h"
#include "storage/system/read_wait.h"

namespace planetree::query {

/// Page number to decoded frame: storage and cache joined, with octree's
/// decoder between them. Holds all the memory a model may hold.
class Pager {
 public:
  struct Limits {
    std::uint64_t budget_bytes = 0;
    QueryArena::Needs arena;
    std::uint64_t probe_bytes = 0;  ///< what each probe takes beyond its QueryArena
    unsigned max_probes = 0;
    std::uint64_t thread_bytes = 0;  ///< the same of the probes of the model's own threads,
    unsigned thread_probes = 0;      ///< all together
    Locking locking = Locking::kTry;
    std::chrono::milliseconds wait_limit{};  ///< of an ask, for one page
    cache::Policy policy = cache::Policy::kClock;

    unsigned readers() const noexcept { return max_probes + thread_probes; }
  };

  /// Opens the file, claims and locks the memory, loads and pins the root page.
  /// calls  the system; must outlive this.
  static Result<std::unique_ptr<Pager>> create(storage::PageFile file, const Limits& limits);

  const storage::PageFile& file() const noexcept { return file_; }
  cache::PageCache& cache() const noexcept { return *cache_; }
  /// What each thread that may read a page takes to unpack it.
  std::uint64_t scratch_bytes() const noexcept;
  /// Of the model and its probes; claimed and locked with the cache's.
  QueryArena& query_arena() noexcept { return *query_arena_; }
  std::uint64_t locked_bytes() const noexcept {
    return cache_->stats().locked_bytes + (query_arena_is_locked_ ? query_arena_->bytes() : 0);
  }

 private:
  explicit Pager(storage::PageFile file) : file_(std::move(file)) {}
  Result<void> claim(const Limits& limits);
  Result<void> lock(Locking locking) noexcept;
  bool stored_fits_frame() const noexcept {
    return file_.header().max_stored_bytes <= file_.header().page_bytes;
  }
  Result<cache::FillResult> fill(const cache::FillRequest& request) noexcept;
  storage::ReadLimits read_limits(const cache::FillRequest& request) noexcept;
  storage::ReadWait* read_wait_for(std::uint32_t fetcher) noexcept;

  storage::PageFile file_;
  // Each takes a descriptor while its model is open, and is given to who first needs one; owners
  // without look for what they wait for.
  static constexpr std::uint64_t kMaxReadWaits = 16;
  // Longer than disks take that move; others are left to a thread that gets pages.
  static constexpr std::chrono::milliseconds kMaxReadWait{20};

  std::unique_ptr<std::byte[]> scratch_;  // scratch_bytes() of each owner of the cache
  struct FetcherWait {
    storage::ReadWait wait;
    bool is_granted = false;
  };
  std::unique_ptr<FetcherWait[]> fetcher_waits_;  // of each owner, who may use it if it is given
  std::atomic<std::uint64_t> granted_waits_{0};
  std::chrono::milliseconds max_wait_{};
  std::unique_ptr<cache::PageCache> cache_;
  std::optional<QueryArena> query_arena_;
  bool query_arena_is_locked_ = false;
};

}  // namespace planetree::query
