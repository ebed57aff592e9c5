// A few triangles far outside of a model change no answer, and hardly any cost.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/differential/answer_checks.h"
#include "tests/differential/parted_model.h"
#include "tests/oracle/closed_models.h"

namespace planetree::oracle {
namespace {

// A closed stray about `at`, a tenth as large as it is far.
Soup stray(const Vec3& at) {
  const double far = std::max({std::fabs(at.x), std::fabs(at.y), std::fabs(at.z)});
  return tetrahedron(at, at + Vec3{0.1 * far, 0, 0}, at + Vec3{0, 0.1 * far, 0},
                     at + Vec3{0, 0, 0.1 * far});
}

// Strays on every side.
Soup strays(double far) {
  return stray({far, far, far}) + stray({-far, -far, -far}) + stray({0.1, -far, 0.2}) +
         stray({far, 0, -far});
}

Soup statue() { return ball(4); }

Vec3 random_vector(Random& random, double size) {
  return {random.between(-size, size), random.between(-size, size), random.between(-size, size)};
}

class Stray : public testing::TestWithParam<double> {};

TEST_P(Stray, ChangesNoAnswer) {
  const double far = GetParam();
  const Soup core = statue();
  const Soup all = core + strays(far);
  for (const std::uint32_t page_bytes : {4096u, 65536u}) {
    BuiltModel alone(core, {.page_bytes = page_bytes}), beside(all, {.page_bytes = page_bytes});
    EXPECT_EQ(beside.model().info().strays, 16u);
    EXPECT_EQ(beside.model().info().core_upper.x, alone.model().info().box_upper.x);
    Random random(5);
    for (int i = 0; i < 200 && !testing::Test::HasFailure(); ++i) {
      const Vec3 query = random_vector(random, i % 2 == 0 ? 1.2 : 4);
      expect_same_bits(beside.closest_point(query), alone.closest_point(query));
      expect_sound(beside, query);
      expect_side(beside, query);
    }
  }
}

TEST_P(Stray, IsFoundByQueriesNearIt) {
  const double far = GetParam();
  BuiltModel beside(statue() + strays(far), {.page_bytes = 4096});
  Random random(6);
  for (int i = 0; i < 60 && !testing::Test::HasFailure(); ++i) {
    const Vec3 from_stray = random_vector(random, 0.3 * far);
    const Vec3 query = i % 2 == 0 ? Vec3{far, far, far} + from_stray
                                  : random_vector(random, i % 3 == 0 ? far : 0.01 * far);
    expect_sound(beside, query);
    expect_side(beside, query);
    // What is left undone widens the interval.
    QueryOptions few;
    few.max_work = static_cast<std::uint32_t>(1 + random.bits() % 6);
    expect_sound(beside, query, few);
  }
}

TEST_P(Stray, LeavesOpenModelsSound) {
  Soup open = statue();
  open.resize(open.size() - 7);
  Soup all = open + strays(GetParam());
  all.pop_back();
  BuiltModel beside(all, {.page_bytes = 4096});
  EXPECT_EQ(beside.model().info().strays, 15u);
  Random random(7);
  for (int i = 0; i < 100 && !testing::Test::HasFailure(); ++i) {
    const Vec3 query = random_vector(random, i % 4 == 0 ? GetParam() : 1.5);
    expect_sound(beside, query);
    expect_side(beside, query);
  }
}

// Work is counted by its limit: the least one that suffices.
std::uint32_t least_work(BuiltModel& model, const Vec3& query) {
  std::uint32_t low = 1, high = 1 << 20;
  while (low < high) {
    const std::uint32_t middle = (low + high) / 2;
    QueryOptions options;
    options.max_work = middle;
    if (model.closest_point(query, options).status == Status::kExact)
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

// Compares the work of queries to a statue alone and beside strays.
void expect_hardly_any_work(const Soup& strays) {
  BuiltModel alone(ball(6)), beside(ball(6) + strays);
  Random random(8);
  std::uint64_t work_alone = 0, work_beside = 0;
  for (int i = 0; i < 100; ++i) {
    // Every other query is near the surface, where faces decide sides.
    Vec3 query = random_vector(random, 1.3);
    if (i % 2 == 0) query = alone.closest_point(query).point * 1.001;
    work_alone += least_work(alone, query);
    work_beside += least_work(beside, query);
  }
  EXPECT_LE(work_beside, work_alone * 13 / 10);
}

TEST_P(Stray, CostsHardlyAnyWork) { expect_hardly_any_work(strays(GetParam())); }

// One triangle far away, which nothing closes.
Soup open_stray(double far) {
  Soup all = stray({far, far, far});
  all.resize(1);
  return all;
}

TEST_P(Stray, CostsHardlyAnyWorkIfItIsOpen) { expect_hardly_any_work(open_stray(GetParam())); }

TEST_P(Stray, DoesNotMakeASheetOfASolid) {
  BuiltModel beside(statue() + open_stray(GetParam()));
  EXPECT_EQ(beside.model().info().strays, 1u);
  EXPECT_EQ(beside.model().info().side_rule, SideRule::kSolid);
  EXPECT_LT(beside.model().info().openness, 1e-9);
  EXPECT_EQ(beside.closest_point({0.1, 0.2, 0.3}).side, Side::kInside);
}

INSTANTIATE_TEST_SUITE_P(Far, Stray, testing::Values(1e3, 1e6, 1e8, 1e12, 1e15, 1e20, 1e30));

// Corners of the core are joined to a vertex far away, as by a wrong coordinate.
TEST(StraySpikes, LeaveAnswersSound) {
  for (const double far : {50.0, 1e3, 5e4, 1e7}) {
    Soup all = statue();
    const Vec3 tip{far, -0.3 * far, 0.2 * far};
    for (const std::size_t hit : {3u, 100u, 1500u}) {
      const Corners face = all[hit];
      // The face becomes the other three faces of a tetrahedron.
      all[hit] = {face[0], face[1], tip};
      all.push_back({face[1], face[2], tip});
      all.push_back({face[2], face[0], tip});
    }
    BuiltModel model(all, {.page_bytes = 4096});
    EXPECT_TRUE(model.model().info().watertight());
    EXPECT_EQ(model.model().info().strays, far < 1e7 ? 9u : 0u) << far;
    Random random(9);
    for (int i = 0; i < 150 && !testing::Test::HasFailure(); ++i) {
      const Vec3 query =
          i % 3 == 0 ? tip * random.between(0, 1.1) : random_vector(random, i % 3 == 1 ? 1.2 : 5);
      expect_sound(model, query);
      expect_side(model, query);
    }
  }
}

TEST(StrayRegions, AnswerAsTheWholeModelDoes) {
  const RegionBox boxes[] = {{{-0.5, -0.5, -0.5}, {0.7, 0.6, 0.5}},
                             {{0.2, -9, -9}, {9, 9, 9}},
                             {{-1e9, -1e9, -1e9}, {0.3, 1e9, 1e9}},
                             {{9e5, 9e5, 9e5}, {1.02e6, 1.02e6, 1.02e6}}};
  for (const RegionBox& box : boxes) {
    WholeAndRegion model(statue() + strays(1e6), box);
    Random random(10);
    for (int i = 0; i < 200 && !testing::Test::HasFailure(); ++i)
      model.check(some_query(random, statue() + strays(1e6), box, 1));
  }
}

}  // namespace
}  // namespace planetree::oracle
