// The file of a region gives the answers of the whole surface's file, or reports that it cannot.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/differential/parted_model.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/winding.h"

namespace planetree::oracle {
namespace {

// Queries all over the region and around it. Every point within the walls gets a side.
void check_solid(const Soup& soup, const RegionBox& box, Seen* seen = nullptr) {
  for (const std::uint32_t page_bytes : {4096u, 65536u}) {
    WholeAndRegion model(soup, box, 1, page_bytes);
    ASSERT_TRUE(model.part().model().info().watertight());
    Random random(9);
    for (int k = 0; k < 300 && !testing::Test::HasFailure(); ++k) {
      const Vec3 query = some_query(random, soup, box, 1);
      model.check(query);
      if (model.walls().distance(query) >= 0) {
        EXPECT_EQ(model.part().probe().contains(query).side, exact_side(query, soup));
      }
    }
    if (seen != nullptr) *seen = model.seen();
  }
}

TEST(Region, AnswersWhereTheBoxCutsThinParts) {
  check_solid(box({0, 0, 0}, {1, 1, 1e-6}), {{0.25, 0.25, -1}, {0.5, 0.5, 1}});
  check_solid(box({0, 0, 0}, {1, 1, 1e-6}), {{0.25, 0.25, 5e-7}, {0.5, 0.5, 2e-6}});
  check_solid(box({0, 0, 0}, {1, 1e-9, 1e-9}), {{0.25, -1, 4e-10}, {0.5, 1, 1}});
}

TEST(Region, FindsSidesInNestedAndOverlappingSolids) {
  const Soup nested = ball(3) + scaled(inside_out(ball(3)), 0.75) + scaled(ball(2), 0.5);
  const Soup twice = ball(3) + translated(ball(3), {0.3, 0.1, 0.2});
  for (const Soup& soup : {nested, twice, inside_out(twice), twice + twice}) {
    Seen seen;
    check_solid(soup, {{0.1, -0.2, -0.3}, {0.9, 0.4, 0.35}}, &seen);
    EXPECT_GT(seen.inside, 50);
  }
}

// Far inside, every exit segment needs surface that the region lacks: every winding number is two
// or three.
TEST(Region, CountsWindingsOfSurfaceOutsideTheRegion) {
  const Soup shells = ball(3) + scaled(ball(2), 1.5) + scaled(ball(2), 0.5);
  WholeAndRegion model(shells, {{0.3, -0.2, -0.2}, {0.6, 0.2, 0.2}});
  EXPECT_EQ(model.part().probe().contains({0.55, 0, 0}).side, Side::kInside);
  Seen seen;
  check_solid(shells, {{0.3, -0.2, -0.2}, {0.6, 0.2, 0.2}}, &seen);
  EXPECT_EQ(seen.outside, 0);
}

TEST(Region, AcceptsWallsInFacesAndVertices) {
  const Soup cube = box({0, 0, 0}, {1, 1, 1}), two = cube + box({1, 0, 0}, {2, 1, 1});
  check_solid(cube, {{0, 0, 0}, {1, 1, 1}});
  check_solid(cube, {{0.5, 0, 0}, {1, 0.5, 0.5}});
  check_solid(two, {{1, 0, 0}, {1.5, 1, 1}});
  check_solid(two, {{0.5, 0.25, 0.25}, {1, 0.75, 0.75}});
  check_solid(ball(2), {{0, 0, 0}, {1, 1, 1}});
  check_solid(ball(2), {{-1, -1, 0}, {1, 1, 0}});
}

TEST(Region, MayBeAPlaneALineOrAPoint) {
  const Soup solid = ball(3);
  const Vec3 corner = solid[100][0];
  check_solid(solid, {{-1, -1, corner.z}, {1, 1, corner.z}});
  check_solid(solid, {{-2, -2, 0.123}, {2, 2, 0.123}});
  check_solid(solid, {{-2, corner.y, corner.z}, {2, corner.y, corner.z}});
  check_solid(solid, {corner, corner});
}

// If the box is larger than the model, nothing is missing.
TEST(Region, OfTheWholeModelAnswersAsTheModelDoes) {
  Random random(12);
  Soup holed = ball(3);
  holed.resize(300);
  for (const Soup& soup : {ball(3), holed}) {
    for (const RegionBox& box :
         {RegionBox{{-1, -1, -1}, {1, 1, 1}}, RegionBox{{-1e300, -2, -1e9}, {3, 1e308, 1}}}) {
      WholeAndRegion model(soup, box);
      EXPECT_EQ(model.part().model().info().triangles, soup.size());
      EXPECT_EQ(model.part().model().info().content_id[0],
                model.whole().model().info().content_id[0]);
      for (int k = 0; k < 200; ++k) {
        const Vec3 query = nasty_query(random, soup, 1);
        expect_same_bits(model.part().closest_point(query), model.whole().closest_point(query));
      }
    }
  }
}

// Half a model has one wall. Away from the wall, answers reach the model's other sides and beyond.
TEST(Region, HasWallsOnlyWithinTheModel) {
  const Soup solid = ball(4);
  WholeAndRegion model(solid, {{-5, -5, 0.2}, {5, 5, 5}});
  for (const Vec3& query : {Vec3{0, 0, 3}, Vec3{0.9, 0, 1.5}, Vec3{0, 0, 1e4}}) {
    model.check(query);
    EXPECT_EQ(model.part().closest_point(query).status, Status::kExact);
    EXPECT_EQ(model.part().closest_point(query).side, Side::kOutside);
  }
  model.check({0, 0, -3});
  EXPECT_EQ(model.part().closest_point({0, 0, -3}).status, Status::kDegraded);
  EXPECT_EQ(model.part().closest_point({0, 0, -3}).side, Side::kUnknown);
  for (const double far : {1e200, -1e200, 1e308, -1e308}) {
    const ClosestPoint answer = model.part().closest_point({0, 0, far});
    EXPECT_EQ(answer.status, Status::kDegraded) << far;
    EXPECT_LE(answer.lower, std::fabs(far));
    EXPECT_GE(answer.upper, std::fabs(far));
    EXPECT_EQ(answer.side, far > 0 ? Side::kOutside : Side::kUnknown);
  }
}

// So far away that all of the model is in one direction. The other coordinates of a point decide
// which walls it is beyond.
TEST(Region, FindsTheWallsThatAFarPointIsBeyond) {
  const Soup cube = box({0, 0, 0}, {1, 1, 1});
  for (const double far : {1e80, 1e100, 1e300, 1e308, -1e100}) {
    for (const RegionBox& box :
         {RegionBox{{0.25, -10, -10}, {10, 10, 10}}, RegionBox{{-10, -10, -10}, {0.5, 10, 10}}}) {
      WholeAndRegion model(cube, box);
      for (const double x : {0.1, 0.4, 0.9}) {
        const bool within = box.lower.x <= x && x <= box.upper.x;
        const Side side = within ? Side::kOutside : Side::kUnknown;
        for (const Vec3& query : {Vec3{x, 0.5, far}, Vec3{x, far, 0.5}}) {
          EXPECT_EQ(model.part().closest_point(query).side, side) << x << " " << far;
          EXPECT_EQ(model.part().probe().contains(query).side, side);
          EXPECT_EQ(model.part().closest_point(query, {.max_work = 1000}).side, side);
        }
      }
    }
  }
}

// If the wall is as far as the surface, something beyond the wall could be nearer after rounding.
TEST(Region, IsDegradedWhereTheWallIsAsNearAsTheSurface) {
  const Soup two = box({0, 0, 0}, {1, 1, 1}) + box({3, 0, 0}, {4, 1, 1});
  WholeAndRegion model(two, {{-1, -1, -1}, {2, 2, 2}});
  for (const double step : {0.0, 0x1p-52, -0x1p-52, 1e-9, -1e-9})
    model.check({1.5 + step, 0.5, 0.5});
  EXPECT_EQ(model.part().closest_point({1.5, 0.5, 0.5}).status, Status::kDegraded);
  EXPECT_EQ(model.part().closest_point({1.5 - 1e-9, 0.5, 0.5}).status, Status::kExact);
}

TEST(Region, StopsAtMaxDistanceOnlyIfThatIsProven) {
  const Soup two = box({0, 0, 0}, {1, 1, 1}) + box({3, 0, 0}, {4, 1, 1});
  WholeAndRegion model(two, {{-1, -1, -1}, {2.5, 2, 2}});
  QueryOptions options;
  options.max_distance = 0.25;
  model.check({2, 0.5, 0.5}, options);
  EXPECT_EQ(model.part().closest_point({2, 0.5, 0.5}, options).status, Status::kBeyondMaxDistance);
  // The wall is nearer than max_distance, the other box is not.
  const ClosestPoint answer = model.part().closest_point({2.375, 0.5, 0.5}, options);
  EXPECT_EQ(answer.status, Status::kDegraded);
  EXPECT_EQ(answer.triangle, kNoTriangle);
  EXPECT_NEAR(answer.lower, 0.125, 1e-9);
  EXPECT_GE(answer.upper, 0.625);
  options.max_error = 10;
  EXPECT_EQ(model.part().closest_point({2.375, 0.5, 0.5}, options).status, Status::kWithinError);
}

TEST(Region, BatchesAndRealTimeQueriesGiveTheSameAnswers) {
  const Soup solid = ball(4) + translated(ball(3), {0.4, 0.3, 0.2});
  const RegionBox box{{-0.1, -0.2, 0.1}, {0.7, 0.6, 1}};
  WholeAndRegion model(solid, box);
  Random random(31);
  std::vector<Vec3> queries;
  for (int k = 0; k < 400; ++k) queries.push_back(some_query(random, solid, box, 1));
  std::vector<ClosestPoint> answers(queries.size());
  model.part().probe().closest_points(queries, answers);
  QueryOptions at_once;
  at_once.wait = Wait::kNever;
  for (std::size_t k = 0; k < queries.size(); ++k) {
    expect_same_bits(model.part().closest_point(queries[k]), answers[k]);
    model.check(queries[k]);
    // All pages are resident by now.
    expect_same_bits(model.part().closest_point(queries[k], at_once), answers[k]);
  }
}

TEST(Region, RefusesABoxThatTouchesNoTriangle) {
  for (const RegionBox& box :
       {RegionBox{{2, 2, 2}, {3, 3, 3}}, RegionBox{{0, 0, 0}, {0.1, 0.1, 0.1}},
        RegionBox{{0.9, 0.9, 0.9}, {1, 1, 1}}}) {
    const std::string failure = build_failure(ball(2), box);
    EXPECT_EQ(failure, "no triangle touches the box; that of the whole model is -1,-1,-1,1,1,1");
  }
  EXPECT_NE(build_failure(ball(2), RegionBox{{0, 1, 0}, {1, 0, 1}}), "");
  EXPECT_NE(build_failure(ball(2), RegionBox{{0, 0, 0}, {1, kNoWall, 1}}), "");
}

}  // namespace
}  // namespace planetree::oracle
