#pragma once

#include <array>
#include <string_view>

#include "tests/oracle/built_model.h"
#include "tests/oracle/random.h"

/// Models that break careless arithmetic, and queries that hit their critical points.
namespace planetree::oracle {

/// One family of nasty models; make() returns up to 500 triangles of size about 1.
struct NastyFamily {
  std::string_view name;
  Soup (*make)(Random& random);
};

/// All families.
std::span<const NastyFamily> nasty_families();

/// A query for `triangles`, all of size about `size`: far, near, on the surface, on a corner, an
/// ulp beside a corner, or at the middle of an edge.
Vec3 nasty_query(Random& random, std::span<const Corners> triangles, double size);

/// The value, or the next double below or above it.
double one_ulp_off(Random& random, double value);

Vec3 operator+(const Vec3& a, const Vec3& b);
Vec3 operator-(const Vec3& a, const Vec3& b);
Vec3 operator*(const Vec3& a, double factor);

/// A point of the unit circle. Turns from 0 to 1 go around it once, not quite evenly. Uses
/// arithmetic alone, because sines may differ from machine to machine.
std::array<double, 2> on_circle(double turn);

/// Multiplies every corner by `factor`.
Soup scaled(Soup triangles, double factor);
/// Adds `offset` to every corner.
Soup translated(Soup triangles, const Vec3& offset);

/// A random point in the triangle's plane, mostly within the triangle.
Vec3 point_on(Random& random, const Corners& triangle);

}  // namespace planetree::oracle
