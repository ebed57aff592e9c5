#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <new>
#include <vector>

namespace planetree::cache {

/// Disjoint ranges of page numbers below a limit, such as the pages of the files that share a
/// cache. One thread at a time may use it.
class PageRanges {
 public:
  /// Page number that means "no range".
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  explicit PageRanges(std::uint32_t limit) noexcept : limit_(limit) {}

  /// Takes the lowest range of `count` > 0 free page numbers and returns its first one, or kNone if
  /// there is none, or no memory to note it.
  std::uint32_t add(std::uint32_t count) noexcept {
    assert(count > 0);
    std::uint32_t first = 0;
    auto next = ranges_.begin();
    while (next != ranges_.end() && next->first - first < count) first = (next++)->end;
    if (limit_ - first < count) return kNone;
    try {
      ranges_.insert(next, {first, first + count});
    } catch (const std::bad_alloc&) {
      return kNone;
    }
    return first;
  }

  /// Frees the range that begins at `first`, and returns the number of its pages.
  std::uint32_t remove(std::uint32_t first) noexcept {
    const auto range = std::find_if(ranges_.begin(), ranges_.end(),
                                    [first](const Range& each) { return each.first == first; });
    assert(range != ranges_.end());
    const std::uint32_t count = range->end - range->first;
    ranges_.erase(range);
    return count;
  }

 private:
  struct Range {
    std::uint32_t first, end;
  };

  std::uint32_t limit_;
  std::vector<Range> ranges_;  // in the order of their numbers
};

}  // namespace planetree::cache
