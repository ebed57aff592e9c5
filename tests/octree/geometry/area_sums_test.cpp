#include "octree/geometry/area_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace planetree::octree {
namespace {

const Point kLower(-2, -2, -2), kUpper(2, 2, 2);

double openness_of(const std::vector<Triangle>& triangles) {
  AreaSums sums(kLower, kUpper);
  for (const Triangle& triangle : triangles) sums.add(triangle);
  return sums.openness();
}

// An arc of a pipe of length 1 about the x axis.
std::vector<Triangle> pipe(double angle) {
  constexpr int kSteps = 400;
  const auto at = [angle](double x, int i) {
    return Point(x, std::cos(angle * i / kSteps), std::sin(angle * i / kSteps));
  };
  std::vector<Triangle> faces;
  for (int i = 0; i < kSteps; ++i) {
    faces.push_back({at(0, i), at(1, i), at(1, i + 1)});
    faces.push_back({at(0, i), at(1, i + 1), at(0, i + 1)});
  }
  return faces;
}

TEST(AreaSumsOfSurface, IsOneForAFlatSheetAndZeroForNothing) {
  const Point a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(1, 1, 0);
  EXPECT_EQ(openness_of({{a, b, c}}), 1);
  EXPECT_EQ(openness_of({{a, b, c}, {b, d, c}}), 1);
  EXPECT_EQ(openness_of({{a, b, c}, {a, c, b}}), 0);
  EXPECT_EQ(openness_of({{a, b, b}}), 0);
  EXPECT_EQ(openness_of({}), 0);
}

TEST(AreaSumsOfSurface, IsTheShareThatWouldCloseIt) {
  constexpr double kPi = 3.14159265358979323846;
  EXPECT_NEAR(openness_of(pipe(kPi)), 2 / kPi, 1e-4);
  EXPECT_NEAR(openness_of(pipe(2 * kPi)), 0, 1e-12);
}

TEST(AreaSumsOfSurface, DoesNotDependOnOrderAndParts) {
  std::vector<Triangle> triangles = pipe(4);
  const double whole = openness_of(triangles);
  AreaSums all(kLower, kUpper);
  while (!triangles.empty()) {
    AreaSums part(kLower, kUpper);
    for (int i = 0; i < 7 && !triangles.empty(); ++i) {
      part.add(triangles.back());
      triangles.pop_back();
    }
    all.add(part);
  }
  EXPECT_EQ(all.openness(), whole);
  EXPECT_GT(whole, 0.4);
  EXPECT_LT(whole, 0.6);
}

}  // namespace
}  // namespace planetree::octree
