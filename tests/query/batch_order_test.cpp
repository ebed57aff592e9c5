#include "query/batch_order.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>

#include "octree/octcode.h"

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

TEST(BatchOrder, TellsPlacesApartThatAreAllInOneCorner) {
  const auto order = std::make_unique<BatchOrder>();
  const std::size_t count = 1000;
  const auto code = [](std::size_t i) { return kCodes / 3 * 2 + i * 7 % count; };
  order->sort(count, code);
  for (std::size_t i = 1; i < count; ++i)
    EXPECT_LT(code(order->query(i - 1)), code(order->query(i)));
}

TEST(BatchOrder, GoesByTheFirstBitsThatDiffer) {
  const auto order = std::make_unique<BatchOrder>();
  const auto code = [](std::size_t i) { return i * i * 7919 * 104729 % kCodes; };
  order->sort(BatchOrder::kMost, code);
  for (std::size_t i = 1; i < BatchOrder::kMost; ++i)
    EXPECT_LE(code(order->query(i - 1)) >> 40, code(order->query(i)) >> 40);
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
