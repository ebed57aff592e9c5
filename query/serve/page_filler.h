#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "cache/page_cache.h"
#include "planetree/error.h"
#include "query/serve/read_error.h"
#include "storage/file/page_file.h"
#include "storage/system/read_wait.h"

namespace planetree::query {

/// Reads pages of files and decodes them into frames. Has memory of its own for each fetcher of a
/// cache. Any number of threads may use it for different fetchers.
class PageFiller {
 public:
  struct Limits {
    std::uint64_t fetchers = 0;
    std::uint64_t max_raw_bytes = 0;     ///< of a page of any file
    std::uint64_t max_stored_bytes = 0;  ///< likewise
    std::uint64_t frame_bytes = 0;       ///< of the cache; stored bytes that fit go into the frame
    std::chrono::milliseconds wait_limit{};  ///< longest wait of a query for one page
    bool use_io_uring = true;                ///< OpenOptions::use_io_uring
  };

  /// Memory that claim() takes, with that of the rings that it may make later.
  static std::uint64_t bytes(const Limits& limits) noexcept;
  /// errors  kNoMemory
  Result<void> claim(const Limits& limits) noexcept;

  /// Reads a page of a file into the frame of the request.
  ///
  /// file     of pages within the limits
  /// page     its number in the file; that of the request is the cache's
  ///
  /// return   kLate: the server of a remote file did not give the page, although it was asked again
  Result<cache::FillResult> fill(const storage::PageFile& file, std::uint32_t page,
                                 const cache::FillRequest& request) noexcept;

  /// The last error of fill(), with the URL of a remote file.
  std::optional<Error> read_error() const noexcept { return read_error_.get(); }

 private:
  Result<cache::FillResult> fill_frame(const storage::PageFile& file, std::uint32_t page,
                                       const cache::FillRequest& request) noexcept;
  // Maximum number of fetchers that have a ReadWait. Each takes a file descriptor while the model
  // is open. The first fetchers that need one get one; the others poll.
  static constexpr std::uint64_t kMaxReadWaits = 16;
  // Maximum time of one wait, longer than a disk takes that makes progress. A read that takes
  // longer is left to a fetch thread.
  static constexpr std::chrono::milliseconds kMaxReadWait{20};

  struct FetcherWait {
    storage::ReadWait wait;
    bool is_granted = false;  // the fetcher may use `wait`
  };

  static std::uint64_t max_read_waits(const Limits& limits) noexcept;
  // Where a page is; nothing if that would have to be read and `may_block` is false.
  static Result<std::optional<storage::PageEntry>> entry_of(const storage::PageFile& file,
                                                            std::uint32_t page,
                                                            bool may_block) noexcept;
  static std::uint64_t scratch_bytes(const Limits& limits) noexcept;
  storage::ReadLimits read_limits(const cache::FillRequest& request) noexcept;
  storage::ReadWait* read_wait_for(std::uint32_t fetcher) noexcept;

  Limits limits_;
  std::unique_ptr<std::byte[]> scratch_;          // scratch_bytes() for each fetcher
  std::unique_ptr<FetcherWait[]> fetcher_waits_;  // indexed by fetcher
  std::uint64_t max_read_waits_ = kMaxReadWaits;
  std::atomic<std::uint64_t> granted_waits_{0};
  std::chrono::milliseconds max_wait_{};
  ReadError read_error_;
};

}  // namespace planetree::query
