// The options side_rule and normal_rule, on models whose file says that they are solids.

#include <gtest/gtest.h>

#include <vector>

#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

QueryOptions with_rule(SideRule side, NormalRule normals = NormalRule::kOutward) {
  QueryOptions options;
  options.side_rule = side;
  options.normal_rule = normals;
  return options;
}

TEST(SideRuleOfSolid, IsThatOfTheFileByDefault) {
  const SampleModel sample = SampleModel::masked(octree::sphere(3));
  const Model model = sample.open(std::uint64_t{64} << 20, 2);
  Probe left = make_probe(model), right = make_probe(model);
  EXPECT_EQ(model.info().side_rule, SideRule::kSolid);
  for (const Vec3& query : random_queries(500, -2, 2)) {
    EXPECT_EQ(bits_of(left.closest_point(query)),
              bits_of(right.closest_point(query, with_rule(SideRule::kSolid))));
    EXPECT_EQ(left.contains(query).side, right.contains(query, with_rule(SideRule::kSolid)).side);
  }
}

TEST(SideRuleOfSolid, SurfaceGivesTheSameSidesOfASphere) {
  const SampleModel sample = SampleModel::masked(octree::sphere(3));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  const std::vector<Vec3> queries = random_queries(2000, -2, 2);
  std::vector<Containment> batch(queries.size());
  probe.contains(queries, batch, with_rule(SideRule::kSurface));
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const ClosestPoint solid = probe.closest_point(queries[i]);
    const ClosestPoint front = probe.closest_point(queries[i], with_rule(SideRule::kSurface));
    EXPECT_EQ(bits_of(solid), bits_of(front));
    EXPECT_EQ(probe.contains(queries[i], with_rule(SideRule::kSurface)).side, solid.side);
    EXPECT_EQ(batch[i].side, solid.side);
    EXPECT_EQ(batch[i].status, Status::kExact);
    const ClosestPoint toward =
        probe.closest_point(queries[i], with_rule(SideRule::kOfFile, NormalRule::kTowardQuery));
    const double sign = solid.side == Side::kInside ? -1 : 1;
    EXPECT_EQ(toward.normal.x, sign * solid.normal.x);
    EXPECT_EQ(toward.side, solid.side);
  }
}

TEST(SideRuleOfSolid, SideAloneReportsNoDistance) {
  const SampleModel sample = SampleModel::masked(octree::sphere(3));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  QueryOptions options = with_rule(SideRule::kSurface);
  options.parts = kSide;
  options.max_distance = 0;  // of no concern to the side alone
  const ClosestPoint answer = probe.closest_point({0.1, 0.2, 0.3}, options);
  EXPECT_EQ(answer.side, Side::kInside);
  EXPECT_EQ(answer.status, Status::kExact);
  EXPECT_EQ(answer.triangle, kNoTriangle);
  EXPECT_EQ(answer.lower, 0);
  options.parts = kAllParts;
  EXPECT_EQ(probe.closest_point({0.1, 0.2, 0.3}, options).status, Status::kBeyondMaxDistance);
  EXPECT_EQ(probe.closest_point({0.1, 0.2, 0.3}, options).side, Side::kUnknown);
}

TEST(SideRuleOfSolid, FarQueriesHaveNoSideOfASheet) {
  const SampleModel sample = SampleModel::masked(octree::sphere(3));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  for (const double far : {1e30, 1e200, 1e308}) {
    const ClosestPoint answer =
        probe.closest_point({far, far / 2, 0}, with_rule(SideRule::kSurface));
    EXPECT_EQ(answer.side, Side::kUnknown);
    EXPECT_EQ(answer.status, Status::kDegraded);
    EXPECT_EQ(probe.contains({far, 0, 0}, with_rule(SideRule::kSurface)).status, Status::kDegraded);
    EXPECT_EQ(probe.contains({far, 0, 0}).side, Side::kOutside);
  }
  EXPECT_EQ(probe.closest_point({1e6, 1e5, 0}, with_rule(SideRule::kSurface)).side, Side::kOutside);
}

TEST(SideRuleOfSolid, ValuesOutOfRangeAreBadQueries) {
  const SampleModel sample = SampleModel::masked(octree::sphere(3));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  const Vec3 query{0.1, 0.2, 0.3};
  for (const std::uint8_t value : {std::uint8_t{3}, std::uint8_t{4}, std::uint8_t{255}}) {
    const QueryOptions side = with_rule(SideRule{value});
    EXPECT_EQ(probe.closest_point(query, side).status, Status::kBadQuery);
    EXPECT_EQ(probe.contains(query, side).status, Status::kBadQuery);
    std::vector<Containment> batch(1);
    probe.contains(std::vector<Vec3>{query}, batch, side);
    EXPECT_EQ(batch[0].status, Status::kBadQuery);
    EXPECT_EQ(probe.closest_point(query, with_rule(SideRule::kSolid, NormalRule{value})).status,
              Status::kBadQuery);
  }
}

}  // namespace
}  // namespace planetree::query
