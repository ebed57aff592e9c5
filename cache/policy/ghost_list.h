#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace planetree::cache {

/// The pages evicted last from a queue, without their bytes.
///
/// The list is not stored. Each page has a stamp, the number of pages added when it was added. It
/// is in the list while fewer than `capacity` pages were added after it. So a page taken from the
/// list leaves its place empty until the place is the oldest.
///
/// source  Yang et al. 2023, "FIFO queues are all you need for cache eviction", section 4.3.
///
/// A view of memory that PageCache owns.
class GhostList {
 public:
  /// stamps    one per page, all 0
  /// capacity  maximum number of pages in the list
  /// added     number of pages added before
  GhostList(std::span<std::uint32_t> stamps, std::uint32_t capacity,
            std::uint32_t added = 0) noexcept
      : stamps_(stamps), capacity_(capacity), added_(added) {}

  void add(std::uint32_t page) noexcept {
    if (++added_ == kNoStamp) {
      std::fill(stamps_.begin(), stamps_.end(), kNoStamp);
      ++added_;
    }
    stamps_[page] = added_;
  }

  /// Removes a page. Returns whether it was in the list.
  bool take(std::uint32_t page) noexcept {
    const bool was_in_list = stamps_[page] != kNoStamp && added_ - stamps_[page] < capacity_;
    stamps_[page] = kNoStamp;
    return was_in_list;
  }

 private:
  static constexpr std::uint32_t kNoStamp = 0;

  std::span<std::uint32_t> stamps_;
  std::uint32_t capacity_;
  std::uint32_t added_;
};

}  // namespace planetree::cache
