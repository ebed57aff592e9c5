#include "query/serve/seq_lock.h"

#include <gtest/gtest.h>

#include <thread>

namespace planetree::query {
namespace {

struct Pair {
  std::uint64_t first = 0, second = 0;
};

TEST(SeqLock, StartsEmpty) {
  const SeqLock<Pair> latest;
  std::uint64_t seen = 0;
  Pair value;
  EXPECT_FALSE(latest.load_newer(seen, value));
}

TEST(SeqLock, EachTakerTakesAValueOnce) {
  SeqLock<Pair> latest;
  latest.store({1, 2});
  latest.store({3, 4});
  for (int taker = 0; taker < 2; ++taker) {
    std::uint64_t seen = 0;
    Pair value;
    ASSERT_TRUE(latest.load_newer(seen, value));
    EXPECT_EQ(value.first, 3u);
    EXPECT_EQ(value.second, 4u);
    EXPECT_FALSE(latest.load_newer(seen, value));
  }
}

TEST(SeqLock, ValuesAreNeverTornAndNeverGoBack) {
  SeqLock<Pair> latest;
  constexpr std::uint64_t kLast = 200000;
  std::thread giver([&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) latest.store({i, ~i});
  });
  std::uint64_t seen = 0, before = 0, taken = 0;
  while (before < kLast) {
    Pair value;
    if (!latest.load_newer(seen, value)) continue;
    ASSERT_EQ(value.second, ~value.first);
    ASSERT_GT(value.first, before);
    before = value.first;
    ++taken;
  }
  giver.join();
  EXPECT_GT(taken, 0u);
}

}  // namespace
}  // namespace planetree::query
