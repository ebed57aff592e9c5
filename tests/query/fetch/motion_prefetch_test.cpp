#include "query/serve/motion_prefetch.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace planetree::query {
namespace {

using Seconds = MotionPrefetch::Seconds;

Motion moving(double position, double velocity, std::uint64_t side_searches = 0) {
  Motion motion{{position, 1, 2}, {velocity, 0, 0}};
  motion.side_searches = side_searches;
  return motion;
}

/// The distances along x of all positions that are left.
std::vector<double> ahead_of(MotionPrefetch& prefetch, double from, Seconds fetch_time = {}) {
  std::vector<double> distances;
  while (prefetch.has_next()) distances.push_back(prefetch.next(fetch_time).position.x - from);
  return distances;
}

TEST(MotionPrefetch, HasPositionsAtQuartersOfTheHorizon) {
  MotionPrefetch prefetch;
  EXPECT_FALSE(prefetch.has_next());
  prefetch.take(moving(3, 100), Seconds(0));
  const std::vector<double> distances = ahead_of(prefetch, 3);
  ASSERT_EQ(distances.size(), MotionPrefetch::kPositions);
  for (unsigned i = 0; i < distances.size(); ++i)
    EXPECT_NEAR(distances[i], 100 * MotionPrefetch::kMinHorizon.count() * (i + 1) / 4, 1e-9);
}

TEST(MotionPrefetch, HorizonCoversTwoFetchesWithinItsLimits) {
  for (const auto& [fetch, horizon] : {std::pair(0.001, 0.005), {0.02, 0.04}, {5.0, 0.6}}) {
    MotionPrefetch prefetch;
    prefetch.take(moving(0, 1), Seconds(0));
    EXPECT_NEAR(ahead_of(prefetch, 0, Seconds(fetch)).back(), horizon, 1e-9);
  }
}

// A slow program calls motion() every 20 ms: a horizon of 5 ms would end before its next query.
TEST(MotionPrefetch, HorizonCoversTwoMotions) {
  MotionPrefetch prefetch;
  for (int i = 0; i < 60; ++i) prefetch.take(moving(0, 1), Seconds(0.02 * i));
  EXPECT_NEAR(ahead_of(prefetch, 0).back(), 0.04, 0.001);
}

// On a circle, a straight line would miss by the square of the time.
TEST(MotionPrefetch, FollowsATurnExceptAtTheLastPosition) {
  constexpr double kTurnsPerSecond = 40;
  const auto motion_at = [](double time) {
    const double angle = kTurnsPerSecond * time;
    return Motion{{std::cos(angle), std::sin(angle), 0},
                  {-kTurnsPerSecond * std::sin(angle), kTurnsPerSecond * std::cos(angle), 0}};
  };
  MotionPrefetch prefetch;
  constexpr int kMotions = 100;
  for (int i = 0; i <= kMotions; ++i) prefetch.take(motion_at(1e-3 * i), Seconds(1e-3 * i));
  const double step = MotionPrefetch::kMinHorizon.count() / MotionPrefetch::kPositions;
  for (unsigned at = 1; prefetch.has_next(); ++at) {
    const double time = step * at, angle = kTurnsPerSecond * time;
    const Vec3 ahead = prefetch.next({}).position;
    const Vec3 there = motion_at(1e-3 * kMotions + time).position;
    const double miss = std::hypot(ahead.x - there.x, ahead.y - there.y);
    if (at < MotionPrefetch::kPositions)
      EXPECT_LT(miss, 0.35 * angle * angle / 2) << at;
    else
      EXPECT_NEAR(miss, angle * angle / 2, 0.05 * angle * angle) << at;
  }
}

// A velocity that is not known well seems to turn wildly.
TEST(MotionPrefetch, TurnIsAtMostAsLongAsTheWay) {
  MotionPrefetch prefetch;
  for (int i = 0; i < 50; ++i) {
    const double sign = i % 2 == 0 ? 1 : -1;
    prefetch.take({{0, 0, 0}, {1, 3 * sign, 0}}, Seconds(1e-4 * i));
  }
  const double step = MotionPrefetch::kMinHorizon.count() / MotionPrefetch::kPositions;
  for (unsigned at = 1; prefetch.has_next(); ++at) {
    const Vec3 ahead = prefetch.next({}).position;
    EXPECT_LE(std::hypot(ahead.x, ahead.y), 2.001 * std::sqrt(10.0) * step * at);
  }
}

TEST(MotionPrefetch, NewerMotionReplacesThePositionsLeft) {
  MotionPrefetch prefetch;
  prefetch.take(moving(0, 1), Seconds(0));
  (void)prefetch.next({});
  prefetch.take(moving(10, 1), Seconds(0.001));
  const std::vector<double> distances = ahead_of(prefetch, 10);
  ASSERT_EQ(distances.size(), MotionPrefetch::kPositions);
  EXPECT_GT(distances.front(), 0);
  EXPECT_LT(distances.back(), 1);
}

TEST(MotionPrefetch, TellsThePositionsThatAreLeft) {
  MotionPrefetch prefetch, other;
  for (MotionPrefetch* const each : {&prefetch, &other}) {
    each->take({{0, 0, 0}, {100, 0, 0}}, Seconds(0));
    each->take({{1, 0, 0}, {100, 20, 0}}, Seconds(0.01));
  }
  std::array<Vec3, MotionPrefetch::kPositions> room;
  EXPECT_EQ(prefetch.left({}, room).size(), MotionPrefetch::kPositions);
  (void)prefetch.next({});
  (void)other.next({});
  const auto left = prefetch.left({}, room);
  ASSERT_EQ(left.size(), MotionPrefetch::kPositions - 1);
  for (const Vec3& position : left) {
    const Vec3 expected = other.next({}).position;
    EXPECT_EQ(position.x, expected.x);
    EXPECT_EQ(position.y, expected.y);
  }
  EXPECT_TRUE(other.left({}, room).empty());
}

TEST(MotionPrefetch, ProbeAtRestHasNone) {
  MotionPrefetch prefetch;
  prefetch.take(moving(1, 0), Seconds(0));
  EXPECT_FALSE(prefetch.has_next());
  prefetch.take(moving(1, 5), Seconds(0.001));
  prefetch.take(moving(1, 0), Seconds(0.002));
  EXPECT_FALSE(prefetch.has_next());
}

TEST(MotionPrefetch, LeavesJumpsOut) {
  MotionPrefetch prefetch;
  prefetch.take(moving(0, 0), Seconds(0));
  prefetch.take(moving(9, 9000), Seconds(0.001));  // from rest
  EXPECT_FALSE(prefetch.has_next());
  prefetch.take(moving(9, 1), Seconds(0.002));
  EXPECT_TRUE(prefetch.has_next());
  prefetch.take(moving(9, 3.9), Seconds(0.003));
  EXPECT_TRUE(prefetch.has_next());
  prefetch.take(moving(9, -3), Seconds(0.004));  // turns around
  EXPECT_TRUE(prefetch.has_next());
  prefetch.take(moving(50, 100), Seconds(0.005));
  EXPECT_FALSE(prefetch.has_next());
  prefetch.take(moving(50, std::numeric_limits<double>::infinity()), Seconds(0.006));
  EXPECT_FALSE(prefetch.has_next());
  prefetch.take(moving(50, std::nan("")), Seconds(0.007));
  EXPECT_FALSE(prefetch.has_next());
}

TEST(MotionPrefetch, SearchesForSidesForAWhileAfterTheProbeDid) {
  MotionPrefetch prefetch;
  const auto searches_after = [&prefetch](std::uint64_t searches) {
    prefetch.take(moving(0, 1, searches), Seconds(0));
    return prefetch.next({}).searches_side;
  };
  EXPECT_FALSE(searches_after(7));  // nothing to compare with
  EXPECT_FALSE(searches_after(7));
  EXPECT_TRUE(searches_after(8));
  for (std::uint32_t i = 1; i < MotionPrefetch::kMotionsAfterSearch; ++i)
    EXPECT_TRUE(searches_after(8)) << i;
  EXPECT_FALSE(searches_after(8));
}

}  // namespace
}  // namespace planetree::query
