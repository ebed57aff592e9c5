#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hwy/contrib/sort/vqsort.h>

namespace planetree::query {

/// What a probe has to put batches in order with.
struct BatchBuffers {
  static constexpr std::size_t kMax = 16384;

  hwy::Sorter sorter;  // here, for where registers have no fixed size it allocates
  std::array<std::uint64_t, kMax> keys{};  // so that none is touched for the first time later
};

/// The order in which queries of a batch are asked: by their places on a curve. Neighbours
/// there look at the same nodes and blocks: at 7 million triangles, a million uniform points take
/// 5 % less time where 131,072 at once are in order, and 12 % less where all are.
class BatchOrder {
 public:
  /// keys  one for each query; used as long as this is.
  explicit BatchOrder(std::span<std::uint64_t> keys) noexcept
      : keys_(keys), index_mask_((std::uint64_t{1} << std::bit_width(keys.size())) - 1) {}

  /// `code(i)` is the Morton code of query i. Codes count as far as their first bits go that are
  /// not the same of all, less those that an index takes: neighbours nearer than that are asked
  /// in the caller's order. No allocation.
  template <class Code>
  void sort(const hwy::Sorter& sorter, const Code& code) noexcept {
    std::uint64_t differing = 0;
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      keys_[i] = code(i);
      differing |= keys_[i] ^ keys_[0];
    }
    const int same = std::countl_zero(differing | 1);
    for (std::size_t i = 0; i < keys_.size(); ++i) keys_[i] = (keys_[i] << same & ~index_mask_) | i;
    sorter(keys_.data(), keys_.size(), hwy::SortAscending());
  }

  /// The query that comes i-th.
  std::size_t query(std::size_t i) const noexcept { return keys_[i] & index_mask_; }

 private:
  const std::span<std::uint64_t> keys_;
  const std::uint64_t index_mask_;
};

}  // namespace planetree::query
