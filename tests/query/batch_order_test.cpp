#include "query/batch_order.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>

namespace planetree::query {
namespace {

constexpr std::uint64_t kCodes = std::uint64_t{1} << 3 * octree::kLevels;

TEST(BatchOrder, GoesByCode) {
  const auto order = std::make_unique<BatchOrder>();
  const std::uint64_t codes[] = {kCodes - 1, 0, kCodes / 2, kCodes / 4};
  order->sort(4, [&](std::size_t i) { return codes[i]; });
  EXPECT_EQ(order->query(0), 1u);
  EXPECT_EQ(order->query(1), 3u);
  EXPECT_EQ(order->query(2), 2u);
  EXPECT_EQ(order->query(3), 0u);
}

TEST(BatchOrder, NamesEachQueryOnce) {
  const auto order = std::make_unique<BatchOrder>();
  for (const std::size_t count : {std::size_t{1}, std::size_t{5000}, BatchOrder::kMost}) {
    order->sort(count, [](std::size_t i) { return i * i * 7919 % kCodes; });
    std::set<std::size_t> named;
    for (std::size_t i = 0; i < count; ++i) named.insert(order->query(i));
    EXPECT_EQ(named.size(), count);
    EXPECT_EQ(*named.rbegin(), count - 1);
  }
}

TEST(BatchOrder, KeepsTheCallersOrderOfEquals) {
  const auto order = std::make_unique<BatchOrder>();
  order->sort(100, [](std::size_t) { return kCodes - 1; });
  for (std::size_t i = 0; i < 100; ++i) EXPECT_EQ(order->query(i), i);
}

}  // namespace
}  // namespace planetree::query
