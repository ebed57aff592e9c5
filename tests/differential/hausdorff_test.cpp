#include "tools/compare/hausdorff_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/oracle/built_model.h"
#include "tests/oracle/cgal_hausdorff.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

namespace planetree::tools {
namespace {

using oracle::BuiltModel;
using oracle::Corners;
using oracle::Soup;
using oracle::operator+;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Found {
  HausdorffInterval interval;
  bool is_within_error = false;
  std::uint64_t splits = 0;
};

Found search(BuiltModel& model, const Soup& mesh, const HausdorffGoal& goal,
             double max_distance = kInfinity, double spacing = kInfinity) {
  HausdorffSearch search(model.probe(), goal, max_distance);
  QueryOptions options{.parts = kDistance, .max_distance = max_distance};
  MeshPieceMaker maker({spacing}, [&](const MeshPiece& piece) {
    std::vector<ClosestPoint> answers(piece.corners.size());
    model.probe().closest_points(piece.corners, answers, options);
    return search.add(piece, answers);
  });
  for (const Corners& triangle : mesh) EXPECT_TRUE(maker.add(triangle));
  EXPECT_TRUE(maker.finish());
  EXPECT_TRUE(search.refine([](std::uint64_t) {}));
  return {search.interval(), search.is_within_error(), search.splits()};
}

/// A square of 2 * n * n triangles about the z axis, at a height.
Soup square(int n, double half, double z) {
  Soup soup;
  const auto at = [&](int i, int j) {
    return Vec3{half * (2.0 * i / n - 1), half * (2.0 * j / n - 1), z};
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      soup.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      soup.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return soup;
}

/// A sphere of radius 1: rings of triangles with one at each pole.
Soup sphere(int rings) {
  Soup soup;
  const int sides = 2 * rings;
  const auto at = [&](int ring, int side) -> Vec3 {
    const auto [height, radius] = oracle::on_circle(0.5 * ring / rings);
    const auto [x, y] = oracle::on_circle(static_cast<double>(side % sides) / sides);
    return {radius * x, radius * y, height};
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int side = 0; side < sides; ++side) {
      const Corners upper{at(ring, side), at(ring + 1, side), at(ring + 1, side + 1)};
      const Corners lower{at(ring, side), at(ring + 1, side + 1), at(ring, side + 1)};
      if (ring + 1 < rings) soup.push_back(upper);
      if (ring > 0) soup.push_back(lower);
    }
  return soup;
}

void expect_holds(const Found& found, double truth, double error) {
  EXPECT_LE(found.interval.lower, truth + error);
  EXPECT_GE(found.interval.upper, truth - error);
}

TEST(HausdorffSearch, HoldsTheValueOfCgalForRandomTriangles) {
  constexpr double kError = 1e-3, kCgalError = 1e-5;
  std::uint64_t splits = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    oracle::Random random(seed);
    const auto soup = [&](int count, double size) {
      Soup made;
      for (int i = 0; i < count; ++i) {
        const Vec3 middle{random.either_sign(), random.either_sign(), random.either_sign()};
        Corners triangle;
        for (Vec3& corner : triangle)
          corner = middle + Vec3{size * random.either_sign(), size * random.either_sign(),
                                 size * random.either_sign()};
        made.push_back(triangle);
      }
      return made;
    };
    BuiltModel model(soup(40, 0.3));
    const Soup mesh = soup(10, 0.8);
    const Found found = search(model, mesh, {kError});
    EXPECT_TRUE(found.is_within_error);
    EXPECT_LE(found.interval.upper, found.interval.lower + kError);
    splits += found.splits;
    expect_holds(found, oracle::cgal_hausdorff(mesh, model.triangles(), kCgalError), kCgalError);
  }
  EXPECT_GT(splits, 0u);
}

TEST(HausdorffSearch, HoldsTheValueOfCgalForSpheres) {
  BuiltModel model(sphere(8));
  for (const double factor : {0.7, 1.0, 1.2}) {
    const Soup mesh = oracle::scaled(sphere(5), factor);
    const Found found = search(model, mesh, {1e-3});
    EXPECT_TRUE(found.is_within_error);
    expect_holds(found, oracle::cgal_hausdorff(mesh, model.triangles(), 1e-5), 1e-5);
  }
}

TEST(HausdorffSearch, FindsTheShiftOfAPlane) {
  for (const double offset : {0.0, 1e5}) {
    const Vec3 move{offset, -offset, offset};
    BuiltModel model(oracle::translated(square(7, 1, 0), move));
    const Found found =
        search(model, oracle::translated(square(5, 1, 0.25), move), {std::nullopt, 1e-6});
    EXPECT_TRUE(found.is_within_error);
    EXPECT_LE(found.interval.lower, 0.25);
    EXPECT_GE(found.interval.upper, 0.25);
    EXPECT_GT(found.interval.lower, 0.25 * 0.99);
    EXPECT_LT(found.interval.upper, 0.25 * 1.01);
  }
}

/// Needles that stand on the corners of square(1, 1, 0). The middle of the square, which is within
/// an edge, is farthest from them.
Soup posts() {
  Soup posts;
  for (const Corners& triangle : square(1, 1, 0))
    for (const Vec3& corner : triangle)
      posts.push_back({corner, corner + Vec3{0, 0, 0.1}, corner + Vec3{0, 0, 0.2}});
  return posts;
}

TEST(HausdorffSearch, FindsWhatIsWithinATriangle) {
  BuiltModel model(posts());
  const Soup mesh = square(1, 1, 0);
  const Found found = search(model, mesh, {1e-3});
  EXPECT_NEAR(found.interval.lower, std::sqrt(2), 1e-3) << "the middle of the square";
  EXPECT_GE(found.interval.upper, std::sqrt(2));
  const Found cut = search(model, mesh, {1e-3}, kInfinity, 0.3);
  EXPECT_GE(cut.interval.upper, std::sqrt(2));
  EXPECT_NEAR(cut.interval.lower, std::sqrt(2), 1e-3);
  EXPECT_LT(cut.splits, found.splits);
}

TEST(HausdorffSearch, IsNearZeroForTheModelItself) {
  BuiltModel flat(square(9, 1, 0.3));
  const Found near = search(flat, flat.triangles(), {std::nullopt, 1e-6});
  EXPECT_EQ(near.interval.lower, 0);
  EXPECT_LT(near.interval.upper, 1e-12);
  EXPECT_EQ(near.splits, 0u) << "each triangle is near its own corners";
  // More triangles meet at a pole than are found there.
  BuiltModel round(sphere(9));
  const Found found = search(round, round.triangles(), {std::nullopt, 1e-6});
  EXPECT_EQ(found.interval.lower, 0);
  EXPECT_LT(found.interval.upper, 1e-6);
}

TEST(HausdorffSearch, HoldsWhenItsSplitsAreSpent) {
  BuiltModel model(posts());
  double width = kInfinity;
  for (const std::uint64_t splits : {0U, 1U}) {
    const Found found = search(model, square(1, 1, 0), {1e-9, 0, splits});
    EXPECT_LE(found.splits, splits);
    EXPECT_FALSE(found.is_within_error);
    expect_holds(found, std::sqrt(2), 0);
    EXPECT_LT(found.interval.upper - found.interval.lower, width);
    width = found.interval.upper - found.interval.lower;
  }
}

TEST(HausdorffSearch, EndsForAnErrorBelowThatOfTheDistances) {
  BuiltModel model(square(3, 1, 0));
  const Found found = search(model, square(2, 1, 0.5), {0.0});
  EXPECT_FALSE(found.is_within_error);
  expect_holds(found, 0.5, 0);
}

TEST(HausdorffSearch, HasNoUpperEndBeyondTheMaximumDistance) {
  BuiltModel model(square(3, 1, 0));
  const Found found = search(model, square(2, 1, 0.5), {1e-3}, 0.25);
  EXPECT_EQ(found.interval.lower, 0.25);
  EXPECT_EQ(found.interval.upper, kInfinity);
  EXPECT_FALSE(found.interval.has_nearest);
}

}  // namespace
}  // namespace planetree::tools
