#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "cache/page_cache.h"
#include "planetree/error.h"
#include "query/serve/page_filler.h"
#include "storage/file/page_file.h"

namespace planetree::query {

/// The cache of a scene, and the files whose pages it holds.
class ScenePager {
 public:
  /// limits  of a shared cache; `reserved_bytes` is without the memory of this class
  /// errors  kNoMemory
  static Result<std::unique_ptr<ScenePager>> create(const cache::CacheLimits& limits,
                                                    const PageFiller::Limits& filler);

  cache::PageCache& cache() const noexcept { return *cache_; }

  /// Adds the pages of a file and pins its root. Returns the number that the cache has for its
  /// first page. Any thread, one at a time with remove().
  ///
  /// file        must outlive the pages
  /// page_count  pages of it that are used
  /// bytes       memory of the caller for this file
  /// errors      kNoMemory; those of reading the root
  Result<std::uint32_t> add(const storage::PageFile& file, std::uint32_t page_count,
                            std::uint64_t bytes);
  /// Removes the pages of a file, which nobody uses.
  ///
  /// first, bytes  returned by and given to add()
  void remove(std::uint32_t first, std::uint64_t bytes) noexcept;

 private:
  struct Pages {
    std::uint32_t first;
    const storage::PageFile* file;
  };

  Result<cache::FillResult> fill(const cache::FillRequest& request) noexcept;

  PageFiller filler_;
  std::mutex mutex_;  // guards `files_`
  std::vector<Pages> files_;
  std::unique_ptr<cache::PageCache> cache_;
};

}  // namespace planetree::query
