// Prisms over polygons that are not convex. The oracle measures to the polygons themselves: it
// knows no triangles.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/octree/builder/mesh/mesh_recorder.h"
#include "tests/octree/support/polygon_shapes.h"
#include "tests/oracle/built_model.h"

namespace planetree::oracle {
namespace {

using octree::FlatPoint;
using octree::FlatPolygon;

constexpr double kHeight = 3;

/// The prism over a polygon as an OBJ whose coordinates are permuted, so that its caps face along
/// any axis.
std::string prism_of(const FlatPolygon& polygon, unsigned axis) {
  std::string text;
  for (const char* height : {"0", "3"})
    for (const auto& [u, v] : polygon) {
      std::string words[3];
      words[axis] = height;
      words[(axis + 1) % 3] = std::to_string(u);
      words[(axis + 2) % 3] = std::to_string(v);
      text += "v " + words[0] + " " + words[1] + " " + words[2] + "\n";
    }
  const std::size_t count = polygon.size();
  std::string bottom = "f", top = "f";
  for (std::size_t k = 0; k < count; ++k) {
    bottom += " " + std::to_string(count - k);
    top += " " + std::to_string(count + k + 1);
    const std::size_t next = (k + 1) % count;
    text += "f " + std::to_string(k + 1) + " " + std::to_string(next + 1) + " " +
            std::to_string(count + next + 1) + " " + std::to_string(count + k + 1) + "\n";
  }
  return text + bottom + "\n" + top + "\n";
}

struct Expected {
  double distance = 0;
  bool inside = false;
};

/// Distance and side of the prism, by the distance to each edge of the polygon and by the parity of
/// the edges to the right.
Expected expected_at(const FlatPolygon& polygon, double u, double v, double w) {
  double edge = INFINITY;
  bool within = false;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const FlatPoint &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const auto pu = static_cast<double>(p[0]), pv = static_cast<double>(p[1]);
    const auto qu = static_cast<double>(q[0]), qv = static_cast<double>(q[1]);
    const double length2 = (qu - pu) * (qu - pu) + (qv - pv) * (qv - pv);
    const double share =
        length2 > 0 ? std::clamp(((u - pu) * (qu - pu) + (v - pv) * (qv - pv)) / length2, 0.0, 1.0)
                    : 0;
    edge = std::min(edge, std::hypot(u - pu - share * (qu - pu), v - pv - share * (qv - pv)));
    if ((pv > v) != (qv > v)) within ^= u < pu + (v - pv) / (qv - pv) * (qu - pu);
  }
  const double above = std::max({0 - w, w - kHeight, 0.0});
  const double to_cap = std::min(std::fabs(w), std::fabs(w - kHeight));
  const double to_wall = std::hypot(edge, above), to_caps = within ? to_cap : INFINITY;
  return {std::min(to_wall, to_caps), within && w > 0 && w < kHeight};
}

void expect_answers_of(const FlatPolygon& polygon, std::mt19937_64& random, unsigned axis) {
  const octree::TemporaryFile file(prism_of(polygon, axis), ".obj");
  BuiltModel model(file.path());
  EXPECT_EQ(model.model().info().unbalanced_edges, 0U);
  EXPECT_EQ(model.model().info().triangles, 4 * polygon.size() - 4);
  double lower = 0, upper = 0;
  for (const FlatPoint& p : polygon)
    for (const std::int64_t value : p) {
      lower = std::min(lower, static_cast<double>(value));
      upper = std::max(upper, static_cast<double>(value));
    }
  const auto draw = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  for (int i = 0; i < 100; ++i) {
    double at[3];
    const double w = draw(-1, kHeight + 1), u = draw(lower - 1, upper + 1);
    const double v = draw(lower - 1, upper + 1);
    at[axis] = w, at[(axis + 1) % 3] = u, at[(axis + 2) % 3] = v;
    const Expected expected = expected_at(polygon, u, v, w);
    const ClosestPoint found = model.closest_point({at[0], at[1], at[2]});
    ASSERT_NEAR(found.distance, expected.distance, 1e-12 * (upper - lower)) << u << " " << v;
    if (expected.distance < 1e-9) continue;
    ASSERT_EQ(found.side, expected.inside ? Side::kInside : Side::kOutside) << u << " " << v;
  }
}

TEST(PolygonPrism, AnswersAreThoseOfShapesThatAreNotConvex) {
  std::mt19937_64 random(3);
  for (const FlatPolygon& polygon :
       {octree::u_shape(), octree::star(), octree::comb(6, 7), octree::spiral(9)})
    for (unsigned axis = 0; axis < 3; ++axis)
      ASSERT_NO_FATAL_FAILURE(expect_answers_of(polygon, random, axis));
}

TEST(PolygonPrism, AnswersAreThoseOfPolygonsWithHoles) {
  std::mt19937_64 random(4);
  for (const std::int64_t across : {1, 2, 4})
    ASSERT_NO_FATAL_FAILURE(expect_answers_of(octree::keyholes(across), random, 1));
}

TEST(PolygonPrism, AnswersAreThoseOfRandomPolygons) {
  std::mt19937_64 random(5);
  for (unsigned i = 0; i < 60; ++i) {
    FlatPolygon polygon = octree::random_simple(random, 4 + random() % 30, 20);
    if (polygon.size() < 4) continue;
    ASSERT_NO_FATAL_FAILURE(expect_answers_of(polygon, random, i % 3)) << i;
  }
}

// The outside of the prism is inside of it then, as the caps and walls face the other way.
TEST(PolygonPrism, KeepsTheOrientationOfPolygons) {
  FlatPolygon polygon = octree::u_shape();
  std::reverse(polygon.begin(), polygon.end());
  const octree::TemporaryFile file(prism_of(polygon, 2), ".obj");
  BuiltModel model(file.path());
  EXPECT_EQ(model.model().info().unbalanced_edges, 0U);
  EXPECT_EQ(model.closest_point({1, 2, 1}).side, Side::kInside);  // a winding number of -1
  EXPECT_EQ(model.closest_point({3, 3, 1}).side, Side::kOutside);
  EXPECT_EQ(model.closest_point({3, 3, 1}).distance, 1);
}

}  // namespace
}  // namespace planetree::oracle
