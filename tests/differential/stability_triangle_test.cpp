// Triangles that break careless formulas.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/differential/answer_checks.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

// Queries around a model whose features are about `size` large.
void expect_sound_around(const Soup& triangles, double size, int queries = 300) {
  BuiltModel model(triangles);
  Random random(17);
  for (int i = 0; i < queries && !testing::Test::HasFailure(); ++i)
    expect_sound(model, nasty_query(random, triangles, size));
}

// Rotates, so that no coordinate is a simple number.
Soup tilted(Soup triangles) {
  constexpr double kC = 0.8253356149096783, kS = 0.5646424733950354;
  for (Corners& triangle : triangles)
    for (Vec3& p : triangle) {
      p = {kC * p.x - kS * p.y, kS * p.x + kC * p.y, p.z};
      p = {p.x, kC * p.y - kS * p.z, kS * p.y + kC * p.z};
    }
  return triangles;
}

// A triangle a hundred million times as long as wide.
TEST(StabilityTriangle, Needle) {
  const Soup needle{{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1e-8, 0}}};
  expect_sound_around(needle, 1);
  expect_sound_around(tilted(needle), 1);
}

// One angle is almost 180 degrees.
TEST(StabilityTriangle, Cap) {
  for (const double height : {1e-3, 0x1p-5, 1e-6, 1e-9, 1e-12, 1e-15, 1e-18}) {
    const Soup cap{{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.4, height, 0}}};
    expect_sound_around(cap, 1, 100);
    expect_sound_around(tilted(cap), 1, 100);
  }
}

// Three corners on a line, one of them between the others.
TEST(StabilityTriangle, Collinear) {
  const Soup line{{Vec3{0, 0, 0}, Vec3{1, 2, 3}, Vec3{0.25, 0.5, 0.75}}};
  expect_sound_around(line, 1);
  expect_sound_around(tilted(line), 1);
}

// A segment stored as a triangle; each corner in turn is the repeated one.
TEST(StabilityTriangle, RepeatedVertex) {
  const Vec3 a{0.1, 0.2, 0.3}, b{1.1, -0.7, 0.4};
  for (const Corners& triangle : {Corners{a, a, b}, Corners{a, b, a}, Corners{b, a, a}})
    expect_sound_around({triangle}, 1, 100);
}

// A point is a model too. It may be the origin, where no scale can be derived.
TEST(StabilityTriangle, ZeroSize) {
  const Vec3 at{0.1, 1e9, -3};
  expect_sound_around({{at, at, at}}, 1);
  expect_sound_around({{Vec3{}, Vec3{}, Vec3{}}}, 1);
}

// Edges of subnormal length, down to the smallest double.
TEST(StabilityTriangle, SubnormalEdges) {
  for (const double size : {1e-310, 1e-322, 5e-324}) {
    const Soup small{{Vec3{0, 0, 0}, Vec3{size, 0, 0}, Vec3{0, size, size}},
                     {Vec3{size, size, 0}, Vec3{size, 0, 0}, Vec3{0, size, size}}};
    expect_sound_around(small, size, 100);
    expect_sound_around(small, 1, 100);
  }
}

// Edges whose squares, let alone fourth powers, exceed the range of double.
TEST(StabilityTriangle, EdgesWhoseSquaresOverflow) {
  expect_sound_around({{Vec3{0, 0, 0}, Vec3{1e150, 0, 1e149}, Vec3{0, 3e150, 0}},
                       {Vec3{-1e150, 1e150, 0}, Vec3{1e150, 2e150, 1e149}, Vec3{0, 3e150, 5e150}}},
                      1e150);
}

// Edges below a millimetre in map coordinates, thousands of kilometres from the origin.
TEST(StabilityTriangle, SmallEdgesFarFromTheOrigin) {
  const double x = 1e7, y = -1e7, z = 300;
  expect_sound_around(
      {{Vec3{x, y, z}, Vec3{x + 1e-4, y, z}, Vec3{x, y + 1e-4, z}},
       {Vec3{x + 1e-4, y + 1e-4, z + 1e-5}, Vec3{x + 1e-4, y, z}, Vec3{x, y + 1e-4, z}}},
      1e-4);
}

// An extremely small triangle in a model of size 1: products of its edges underflow.
TEST(StabilityTriangle, TinyFaceInALargeModel) {
  for (int exponent = -140; exponent > -480; exponent -= 20) {
    const double edge = std::ldexp(1.0, exponent);
    BuiltModel model({{Vec3{0, 0, 0}, Vec3{edge, 0, 0}, Vec3{0, edge, 0}},
                      {Vec3{1, 1, 1}, Vec3{2, 1, 1}, Vec3{1, 2, 1}}});
    for (int height = 0; height > -450; height -= 10)
      expect_sound(model, {edge / 4, edge / 4, std::ldexp(1.0, height)});
  }
}

// The borders between the regions in which a corner, an edge or the face is nearest, and an ulp to
// either side of them.
TEST(StabilityTriangle, RegionBorders) {
  const Soup triangles{{Vec3{0, 0, 0}, Vec3{3, 0, 0}, Vec3{1, 2, 0}}};
  BuiltModel model(triangles);
  const Corners& t = triangles[0];
  const Vec3 up{0, 0, 1};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 a = t[k], b = t[(k + 1) % 3], edge = b - a, out{edge.y, -edge.x, 0};
    for (const double along : {0.0, 0.5, 1.0})
      for (const double aside : {-0.25, 0.0, 1.0, 1e9})
        for (const double above : {0.0, 0x1p-60, 1.0}) {
          const Vec3 at = a + edge * along + out * aside + up * above;
          expect_sound(model, at);
          expect_sound(model, {std::nextafter(at.x, 9e9), at.y, at.z});
          expect_sound(model, {at.x, std::nextafter(at.y, -9e9), at.z});
        }
  }
}

// Beyond an obtuse corner, the nearest edge is not the one that the sign of one barycentric
// coordinate suggests.
TEST(StabilityTriangle, ObtuseCornerSwapsRegions) {
  const Soup triangles{{Vec3{0, 0, 0}, Vec3{10, 0, 0}, Vec3{-8, 1, 0}}};
  BuiltModel model(triangles);
  for (double x = -12; x <= 12; x += 0.5)
    for (double y = -6; y <= 6; y += 0.5)
      for (const double z : {0.0, 0.25}) expect_sound(model, {x, y, z});
}

// Triangles of size 1e-6 beside one of size 1e6, and nearer than the large one's rounding.
TEST(StabilityTriangle, SmallBesideLarge) {
  Soup triangles{{Vec3{-1e6, -1e6, 0.1}, Vec3{1e6, -1e6, 0.3}, Vec3{0.7, 1e6, 0.9}}};
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Vec3 at = point_on(random, triangles[0]) * 1e-6;
    triangles.push_back({at, at + random.in_cube() * 1e-6, at + random.in_cube() * 1e-6});
  }
  expect_sound_around(triangles, 1e-6);
  expect_sound_around(triangles, 1);
}

// Specks almost on a large face: the truly nearest triangle may be the one whose computed value is
// larger by a rounding.
TEST(StabilityTriangle, LargeFaceUnderSpecks) {
  Random random(1);
  const Corners face{Vec3{-0.95, -0.97, 0.3}, Vec3{1, -0.9, -0.4}, Vec3{0.1, 1, 0.2}};
  const Vec3 centre = face[0] + (face[1] - face[0]) * 0.3 + (face[2] - face[0]) * 0.3;
  Soup triangles{face};
  for (int i = 0; i < 200; ++i) {
    const Vec3 at = centre + random.in_cube() * 1e-15;
    const auto corner = [&] { return at + random.in_cube() * 1e-15; };
    triangles.push_back({corner(), corner(), corner()});
  }
  BuiltModel model(triangles);
  for (int i = 0; i < 500; ++i) expect_sound(model, centre + random.in_cube() * 2e-15);
}

// Corners and triangles in any order give the same distance, and among equals the lowest index.
TEST(StabilityTriangle, OrderDoesNotMatter) {
  const Vec3 a{0.1, 0.3, 0.7}, b{1.3, -0.2, 0.4}, c{0.6, 1.1, -0.5};
  const Corners other{Vec3{2, 2, 2}, Vec3{3, 2, 2.5}, Vec3{2, 3, 2}};
  Random random(4);
  std::vector<Vec3> queries;
  for (int i = 0; i < 60; ++i) queries.push_back(nasty_query(random, Soup{{a, b, c}, other}, 1));
  BuiltModel reference({{a, b, c}, other});
  using Order = std::array<std::size_t, 3>;
  const Corners corners{a, b, c};
  for (const auto& order : {Order{0, 1, 2}, Order{0, 2, 1}, Order{1, 0, 2}, Order{1, 2, 0},
                            Order{2, 0, 1}, Order{2, 1, 0}}) {
    const Corners permuted{corners[order[0]], corners[order[1]], corners[order[2]]};
    BuiltModel model({other, permuted, {a, b, c}, other});
    for (const Vec3& query : queries) {
      const ClosestPoint expected = reference.closest_point(query),
                         answer = expect_sound(model, query);
      EXPECT_EQ(answer.distance, expected.distance);
      EXPECT_EQ(answer.triangle, expected.triangle == 0 ? 1U : 0U);
    }
  }
}

}  // namespace
}  // namespace planetree::oracle
