#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/octcode.h"

namespace planetree::query {

/// The order in which queries of a batch are asked: by their places on a curve. Neighbours
/// there look at the same nodes: at 7 million triangles, uniform points take two thirds of
/// the time once 16,384 are in order, and little less with more.
class BatchOrder {
 public:
  static constexpr std::size_t kMost = 16384;

  /// `code(i)` is the Morton code of query i; `count` is at most kMost.
  template <class Code>
  void sort(std::size_t count, const Code& code) noexcept {
    for (std::size_t i = 0; i < count; ++i) keys_[i] = code(i) >> kDropped << kIndexBits | i;
    std::sort(keys_.begin(), keys_.begin() + static_cast<std::ptrdiff_t>(count));
  }

  /// The query that comes i-th.
  std::size_t query(std::size_t i) const noexcept { return keys_[i] & (kMost - 1); }

 private:
  static constexpr unsigned kIndexBits = 14;
  static_assert(std::size_t{1} << kIndexBits == kMost);
  // Of a code's bits; neighbours so near each other may be asked in any order.
  static constexpr unsigned kDropped = 3 * octree::kLevels + kIndexBits - 64;

  std::array<std::uint64_t, kMost> keys_{};  // so that none is touched for the first time later
};

}  // namespace planetree::query
