#include "cache/protocol.h"

#include <gtest/gtest.h>

#include <array>

namespace planetree::cache {
namespace {

TEST(PageMap, StartsEmpty) {
  std::array<PageMap::Cell, 3> cells{};
  const PageMap map(cells);
  for (std::uint32_t page = 0; page < 3; ++page) {
    EXPECT_EQ(map.find(page), kNoFrame);
    EXPECT_EQ(map.frame_of(page), kNoFrame);
  }
}

TEST(PageMap, FindsAPublishedPageUntilItIsWithdrawn) {
  std::array<PageMap::Cell, 3> cells{};
  const PageMap map(cells);
  map.publish(1, 0);
  map.publish(2, kNoFrame - 1);
  EXPECT_EQ(map.find(0), kNoFrame);
  EXPECT_EQ(map.find(1), 0u);
  EXPECT_EQ(map.frame_of(2), kNoFrame - 1);
  map.withdraw(1);
  EXPECT_EQ(map.find(1), kNoFrame);
  EXPECT_EQ(map.find(2), kNoFrame - 1);
}

}  // namespace
}  // namespace planetree::cache
