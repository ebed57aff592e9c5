#include "query/serve/batch_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "octree/geometry/octcode.h"

namespace planetree::query {
namespace {

constexpr std::uint64_t kCodes = std::uint64_t{1} << octree::kMortonBits;

template <class Code>
std::vector<std::size_t> order_of(std::size_t count, const Code& code) {
  std::vector<std::uint64_t> keys(count, 0xdecade);
  BatchOrder order(keys);
  order.sort(hwy::Sorter(), code);
  std::vector<std::size_t> queries(count);
  for (std::size_t i = 0; i < count; ++i) queries[i] = order.query(i);
  return queries;
}

std::uint64_t scattered(std::size_t i) { return i * i * 7919 * 104729 % kCodes; }

TEST(BatchOrder, OrdersQueriesByCode) {
  const std::uint64_t codes[] = {kCodes - 1, 0, kCodes / 2, kCodes / 4};
  EXPECT_EQ(order_of(4, [&](std::size_t i) { return codes[i]; }),
            (std::vector<std::size_t>{1, 3, 2, 0}));
}

TEST(BatchOrder, OrdersCodesThatShareTheirLeadingBits) {
  const std::size_t count = 1000;
  const auto code = [](std::size_t i) { return kCodes / 3 * 2 + i * 7 % count; };
  const auto order = order_of(count, code);
  for (std::size_t i = 1; i < count; ++i) EXPECT_LT(code(order[i - 1]), code(order[i]));
}

TEST(BatchOrder, OrdersByTheCodeBitsThatTheIndexLeaves) {
  const auto order = order_of(100'000, &scattered);
  for (std::size_t i = 1; i < order.size(); ++i)
    EXPECT_LE(scattered(order[i - 1]) >> 10, scattered(order[i]) >> 10);
}

TEST(BatchOrder, ContainsEachQueryOnce) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{4095},
                                  std::size_t{4096}, std::size_t{4097}, std::size_t{100'000}}) {
    std::vector<std::size_t> order = order_of(count, &scattered), all(count);
    std::iota(all.begin(), all.end(), 0);
    std::sort(order.begin(), order.end());
    EXPECT_EQ(order, all);
  }
}

TEST(BatchOrder, KeepsTheCallersOrderOfEqualCodes) {
  std::vector<std::size_t> all(5000);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order_of(all.size(), [](std::size_t) { return kCodes - 1; }), all);
}

TEST(BatchOrder, AcceptsAnEmptyBatch) { EXPECT_TRUE(order_of(0, &scattered).empty()); }

TEST(BatchOrder, TellsPathsFromScatteredQueries) {
  const auto is_in_order = [](std::size_t count, const auto& place) {
    return BatchOrder::is_in_order(count, [&](std::size_t i, std::size_t k) {
      return std::fabs(static_cast<double>(place(i)) - static_cast<double>(place(k)));
    });
  };
  const auto hashed = [](std::size_t i) { return i * 0x9e3779b97f4a7c15 >> 40; };
  for (const std::size_t count : {std::size_t{1000}, std::size_t{100'000}}) {
    EXPECT_TRUE(is_in_order(count, [](std::size_t i) { return i; }));
    EXPECT_TRUE(is_in_order(count, [&](std::size_t i) { return count - i; }));
    EXPECT_TRUE(is_in_order(count, [](std::size_t) { return 1; }));
    EXPECT_FALSE(is_in_order(count, hashed));
    // There and back.
    EXPECT_FALSE(is_in_order(count, [&](std::size_t i) { return i % 2 == 0 ? i : count - i; }));
  }
  EXPECT_FALSE(is_in_order(0, hashed));
  EXPECT_FALSE(is_in_order(10, [](std::size_t i) { return i; }));
}

// A query that is not a number has no place.
TEST(BatchOrder, DoesNotTrustQueriesWithoutAPlace) {
  EXPECT_FALSE(
      BatchOrder::is_in_order(1000, [](std::size_t, std::size_t) { return std::nan(""); }));
}

}  // namespace
}  // namespace planetree::query
