#pragma once

#include <atomic>
#include <cstdint>

#include "query/file/open_layers.h"
#include "storage/file/file_layout.h"

namespace planetree::query {

/// The pages of a model in the order of the file, for fetch threads that have nothing else to do.
/// Each page is given out once. The pages of layers that are not opened, and those of the field,
/// are left out: the cache never holds them. Any number of threads may share one.
class ReadAhead {
 public:
  static constexpr std::uint32_t kNoPage = ~std::uint32_t{0};

  ReadAhead(const OpenLayers& opened, const storage::FileHeader& header) noexcept
      : end_(opened.page_count(header)),
        first_unused_(opened.first_unused_page(header)),
        unused_(opened.unused_pages(header)) {}

  /// Returns the next page, kNoPage after the last one.
  std::uint32_t take() noexcept {
    const std::uint32_t count = end_ - unused_;
    if (taken_.load(std::memory_order_relaxed) >= count) return kNoPage;
    const std::uint32_t at = taken_.fetch_add(1, std::memory_order_relaxed);
    if (at >= count) return kNoPage;
    return at < first_unused_ ? at : at + unused_;
  }

 private:
  const std::uint32_t end_, first_unused_, unused_;
  std::atomic<std::uint32_t> taken_{0};  // exceeds the count by at most the number of threads
};

}  // namespace planetree::query
