#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "octree/geometry/triangle_distance.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {

/// A triangle and a box that may touch or not.
struct TriangleAndBox {
  Triangle triangle;
  Point lower, upper;
};

inline Point any_point(Noise& noise, double low, double high) {
  const Vec3 at = noise.point(low, high);
  return {at.x, at.y, at.z};
}

// A point with all 53 bits random.
inline Point full_point(Noise& noise, double low, double high) {
  return any_point(noise, low, high) + 0x1p-31 * any_point(noise, low, high);
}

inline double sign(Noise& noise) { return noise.bits() % 2 == 0 ? 1 : -1; }

inline double next(double value, int steps) {
  const double end = std::copysign(std::numeric_limits<double>::infinity(), steps);
  for (; steps != 0; steps += steps > 0 ? -1 : 1) value = std::nextafter(value, end);
  return value;
}

inline TriangleAndBox random_pair(Noise& noise) {
  const Point lower = full_point(noise, -1, 1);
  const Point edge = full_point(noise, 0, 0.7);
  return {
      {full_point(noise, -1.5, 1.5), full_point(noise, -1.5, 1.5), full_point(noise, -1.5, 1.5)},
      lower,
      lower + edge};
}

// A triangle so long and thin that its normal is mostly rounding.
inline TriangleAndBox needle(Noise& noise) {
  TriangleAndBox pair = random_pair(noise);
  pair.triangle[2] = pair.triangle[0] + 0.7 * (pair.triangle[1] - pair.triangle[0]) +
                     0x1p-50 * any_point(noise, -1, 1);
  return pair;
}

// A triangle from 2^-60 to 2^60 times as large as the box.
inline TriangleAndBox of_other_size(Noise& noise) {
  TriangleAndBox pair = random_pair(noise);
  const double factor = std::ldexp(1.0, static_cast<int>(noise.bits() % 121) - 60);
  const Point at = pair.lower;
  for (Point& corner : pair.triangle) corner = at + (corner - at) * factor;
  return pair;
}

// Lengths whose products underflow.
inline TriangleAndBox tiny(Noise& noise) {
  TriangleAndBox pair = random_pair(noise);
  const double factor = noise.bits() % 2 == 0 ? 1e-300 : 1e-160;
  for (Point& corner : pair.triangle) corner *= factor;
  pair.lower *= factor;
  pair.upper *= factor;
  return pair;
}

// A triangle of size 1e-300 at or beside a corner of a box of size 1.
inline TriangleAndBox tiny_at_a_corner(Noise& noise) {
  TriangleAndBox pair;
  pair.lower = Point(-1, 0, -1);
  pair.upper = Point(0, 1, 0);
  for (Point& corner : pair.triangle) corner = 1e-300 * any_point(noise, -1, 1);
  return pair;
}

// Coordinates of few bits, so that much is in one plane, on one line or at one point.
inline TriangleAndBox on_lattice(Noise& noise) {
  const auto step = [&] { return static_cast<double>(noise.bits() % 7) - 3; };
  const auto index = [&] { return Point(step(), step(), step()); };
  const Point one = index(), other = index();
  return {{index(), index(), index()}, one.cwiseMin(other), one.cwiseMax(other)};
}

inline TriangleAndBox axis_aligned(Noise& noise) {
  TriangleAndBox pair = random_pair(noise);
  const unsigned axis = noise.bits() % 3;
  const double at = noise.bits() % 2 == 0 ? pair.lower[axis] : pair.upper[axis];
  for (Point& corner : pair.triangle)
    corner[axis] = next(at, static_cast<int>(noise.bits() % 3) - 1);
  return pair;
}

// A corner, an edge or the interior of the triangle is at a corner or edge of the box, and the rest
// of it is beyond; then the last bits are changed at random.
inline TriangleAndBox barely(Noise& noise) {
  TriangleAndBox pair = random_pair(noise);
  const Point outward(sign(noise), sign(noise), sign(noise));
  Point at;
  for (unsigned axis = 0; axis < 3; ++axis)
    at[axis] = outward[axis] > 0 ? pair.upper[axis] : pair.lower[axis];
  // The normal of a plane that touches the box at a corner only, or along an edge.
  Point normal = any_point(noise, 0.1, 1).cwiseProduct(outward);
  if (noise.bits() % 2 == 0) {
    const unsigned axis = noise.bits() % 3;
    at[axis] = noise.uniform(pair.lower[axis], pair.upper[axis]);
    normal[axis] = 0;
  }
  const auto in_plane = [&] { return Point(normal.cross(any_point(noise, -1, 1))); };
  const Point u = in_plane(), v = in_plane();
  switch (noise.bits() % 3) {
    case 0:
      pair.triangle = {at, at + u, at + v};
      break;
    case 1:
      pair.triangle = {at - u, at + 0.5 * u, at + v};
      break;
    default:
      pair.triangle = {at + u, at + v, at - u - v};
      break;
  }
  for (Point& corner : pair.triangle)
    for (double& value : corner) value = next(value, static_cast<int>(noise.bits() % 5) - 2);
  std::rotate(pair.triangle.begin(), pair.triangle.begin() + noise.bits() % 3, pair.triangle.end());
  return pair;
}

// As far from the origin as coordinates may be. Cells there are flat or nearly so.
inline TriangleAndBox far_away(Noise& noise) {
  TriangleAndBox pair = barely(noise);
  const Point offset(0x1p54, -0x1p53, 0x1p30);
  for (Point& corner : pair.triangle) corner += offset;
  pair.lower += offset;
  pair.upper += offset;
  return pair;
}

// Boxes so far away that few doubles are between their sides.
inline TriangleAndBox of_few_numbers(Noise& noise) {
  const double size = std::ldexp(1.0, static_cast<int>(noise.bits() % 40));
  const Point offset(0x1p52, -0x1p52, 0x1.8p52);
  const auto whole = [](const Point& point) { return Point(point.array().round()); };
  TriangleAndBox pair = barely(noise);
  const Point from = whole(size * pair.lower);
  for (Point& corner : pair.triangle) corner = offset + whole(size * corner);
  pair.upper = offset + from + whole(size * (pair.upper - pair.lower)).cwiseMax(Point::Ones());
  pair.lower = offset + from;
  return pair;
}

}  // namespace planetree::octree
