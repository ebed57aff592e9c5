#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hwy/contrib/sort/vqsort.h>

namespace planetree::query {

/// Memory with which a probe sorts batches.
struct BatchBuffers {
  static constexpr std::size_t kMax = 16384;

  hwy::Sorter sorter;                      // kept: with scalable vectors its constructor allocates
  std::array<std::uint64_t, kMax> keys{};  // zeroed: no page fault later
};

/// The order in which the queries of a batch run: along a Morton curve, since neighbours on the
/// curve visit the same nodes and blocks. With 7 million triangles, a million uniformly distributed
/// points take 5 % less time if 131,072 are sorted at once, and 12 % less if all are
/// (docs/experiments/batches.md).
class BatchOrder {
 public:
  /// The caller's order.
  BatchOrder() noexcept : index_mask_(0) {}
  /// keys  memory for one key per query; must outlive this
  explicit BatchOrder(std::span<std::uint64_t> keys) noexcept
      : keys_(keys), index_mask_((std::uint64_t{1} << std::bit_width(keys.size())) - 1) {}

  /// Returns whether `count` queries follow each other closely already, as those of a path or of a
  /// curve do, so that they may run in the caller's order. `gap(i, k)` is the distance between two
  /// queries. Looks at a sample: steps from query to query against gaps across the batch. Along a
  /// curve through a volume, steps are about count^(-1/3) of its size.
  template <class Gap>
  static bool is_in_order(std::size_t count, const Gap& gap) noexcept {
    constexpr std::size_t kSamples = 64;
    constexpr double kMaxSteps = 3;  // of the steps of a curve
    if (count <= kSamples) return false;
    double steps = 0, gaps = 0;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const std::size_t at = i * (count - 1) / kSamples;
      const std::size_t other = (i * 29 + 17) % kSamples * (count - 1) / kSamples;
      steps += gap(at, at + 1);
      gaps += gap(at, other);
    }
    return steps * std::cbrt(static_cast<double>(count)) <= kMaxSteps * gaps;
  }

  /// Sorts the queries by Morton code; `code(i)` is the code of query i. A key holds the bits of
  /// the code below the common prefix of all codes, and in its last bits the query's index, which
  /// replaces the last bits of the code. Queries that differ only in those bits keep the caller's
  /// order. Does not allocate.
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

  /// Returns the index of the query that runs i-th.
  std::size_t query(std::size_t i) const noexcept {
    return keys_.empty() ? i : keys_[i] & index_mask_;
  }

 private:
  const std::span<std::uint64_t> keys_;
  const std::uint64_t index_mask_;
};

}  // namespace planetree::query
