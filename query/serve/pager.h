#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "cache/page_cache.h"
#include "octree/mask/mask_prefetcher.h"
#include "octree/traversal/tree_view.h"
#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/types.h"
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
    std::uint64_t probe_bytes = 0;  ///< what each probe takes beyond its QueryArena
    unsigned max_probes = 0;
    std::uint64_t thread_bytes = 0;  ///< the same of the probes of the model's own threads,
    unsigned thread_probes = 0;      ///< all together
    Locking locking = Locking::kTry;
    std::chrono::milliseconds wait_limit{};  ///< of an ask, for one page
    std::uint32_t page_trace_capacity = 0;
    cache::Policy policy = cache::Policy::kClock;

    unsigned readers() const noexcept { return max_probes + thread_probes; }
  };

  /// Opens the file, claims and locks the memory, loads and pins the root page.
  /// calls  the system; must outlive this.
  static Result<std::unique_ptr<Pager>> open(const std::filesystem::path& path,
                                             const Limits& limits, storage::FileCalls& calls);

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
  QueryArena::Needs arena_needs(const Limits& limits) const noexcept;
  Result<void> claim(const Limits& limits);
  Result<void> lock(Locking locking) noexcept;
  bool stored_fits_frame() const noexcept {
    return file_.header().max_stored_bytes <= file_.header().page_bytes;
  }
  Result<cache::Filled> fill(const cache::FillRequest& request) noexcept;
  storage::SoonTerms soon_terms(const cache::FillRequest& request) noexcept;
  storage::ReadWait* wait_of(std::uint32_t fetcher) noexcept;

  storage::PageFile file_;
  // Each takes a descriptor while its model is open, and is given to who first needs one; owners
  // without look for what they wait for.
  static constexpr std::uint64_t kMaxWaits = 16;
  // Longer than disks take that move; others are left to a thread that gets pages.
  static constexpr std::chrono::milliseconds kMaxWaited{20};

  std::unique_ptr<std::byte[]> scratch_;  // scratch_bytes() of each owner of the cache
  struct OwnWait {
    storage::ReadWait wait;
    bool is_given = false;
  };
  std::unique_ptr<OwnWait[]> waits_;  // of each owner, who may use it if it is given
  std::atomic<std::uint64_t> waits_given_{0};
  std::chrono::milliseconds max_waited_{};
  std::unique_ptr<cache::PageCache> cache_;
  std::optional<QueryArena> query_arena_;
  bool query_arena_is_locked_ = false;
};

/// Where pages are, for asking ahead.
inline octree::FrameTable frames_of(const cache::Reader& reader) noexcept {
  return {reader.map().cells(), reader.frames(), reader.stride_bytes()};
}

/// One probe's way to pages during one ask: a section of the cache, begun where a page is
/// first looked for, for that is an exchange with memory, and ended with this object.
///
/// An ask that has waited for a page as long as it may waits for no other.
///
/// It stays where it is made: pages() leads to it.
///
/// wait   kNever: what is not resident cannot be had, and the system is not called.
/// terms  how pages are waited for.
/// stop   of a fetch thread, which reads for others in between: once true, what is not resident
///        cannot be had any more. Else null.
class PageAccessor {
 public:
  PageAccessor(cache::Reader& reader, Wait wait, const cache::FetchTerms& terms = {},
               const std::atomic<bool>* stop = nullptr) noexcept
      : pages_(pages_of(reader)),
        reader_(reader),
        terms_(terms),
        stop_(stop),
        wait_(wait),
        waits_(wait == Wait::kForPages) {}
  ~PageAccessor() {
    if (reader_.inside()) reader_.leave();
  }
  PageAccessor(const PageAccessor&) = delete;
  PageAccessor& operator=(const PageAccessor&) = delete;

  /// What goes on a step with every few pages, to its end or to the next call; null: nothing.
  void set_prefetcher(octree::MaskPrefetcher* ahead) noexcept { prefetcher_ = ahead; }
  /// Where to note what is looked for; null: nowhere.
  void set_trace(PageTraceWriter* log) noexcept { log_ = log; }

  /// The page's frame, good until the next call, or until the keeper that pages() names is told;
  /// null if it cannot be had.
  const std::byte* page(std::uint32_t number) noexcept {
    if (++lookups_ % kLookupsPerSection == 0) {
      release_frames();
      reader_.leave();
    }
    begin();
    if (prefetcher_ && lookups_ % kLookupsPerStep == 0) step_prefetcher();
    if (const std::byte* frame = reader_.find(number)) {
      if (log_) log_->found(number);
      return frame;
    }
    if (waits_ && !(stop_ && stop_->load(std::memory_order_relaxed))) return fetch(number);
    if (log_ && wait_ == Wait::kNever) log_->missed(number);
    missed_ = true;
    return nullptr;
  }

  /// Whether a page was not resident that the ask did not wait for.
  bool missed() const noexcept { return missed_; }

  /// Where page() would find it, or null.
  const std::byte* peek(std::uint32_t number) noexcept {
    begin();
    return reader_.peek(number);
  }

  const octree::PageReader& pages() const noexcept { return pages_; }

 private:
  void begin() noexcept {
    if (!reader_.inside()) reader_.enter();
  }
  // Before a section ends of which there are pointers.
  void release_frames() noexcept {
    if (release_hook_.on_release) release_hook_.on_release(release_hook_.who);
  }
  void step_prefetcher() noexcept {
    prefetcher_->step(pages_);
    if (!prefetcher_->goes_on()) prefetcher_ = nullptr;
  }
  const std::byte* fetch(std::uint32_t number) noexcept;

  // Evicted frames are reused only after sections that may see them end.
  static constexpr std::uint32_t kLookupsPerSection = 256;
  // What a step asks for takes about as long to come.
  static constexpr std::uint32_t kLookupsPerStep = 2;

  octree::PageReader pages_of(const cache::Reader& reader) noexcept {
    return {this,
            [](void* context, std::uint32_t number) noexcept {
              return static_cast<PageAccessor*>(context)->page(number);
            },
            [](void* context, std::uint32_t number) noexcept {
              return static_cast<PageAccessor*>(context)->peek(number);
            },
            frames_of(reader), &release_hook_};
  }

  const octree::PageReader pages_;
  cache::Reader& reader_;
  const cache::FetchTerms terms_;
  const std::atomic<bool>* const stop_;
  octree::FrameReleaseHook release_hook_;
  octree::MaskPrefetcher* prefetcher_ = nullptr;
  PageTraceWriter* log_ = nullptr;
  const Wait wait_;
  bool waits_;  // until it has waited long enough
  bool missed_ = false;
  std::uint32_t lookups_ = 0;
};

}  // namespace planetree::query
