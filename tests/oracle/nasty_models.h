#pragma once

#include <array>
#include <string_view>

#include "tests/oracle/built_model.h"
#include "tests/oracle/random.h"

/// Models that break careless arithmetic, and queries that find the places.
namespace planetree::oracle {

/// One family of nasty models; each makes up to 500 triangles of size about 1.
struct NastyFamily {
  std::string_view name;
  Soup (*make)(Random& random);
};

/// All of them.
std::span<const NastyFamily> nasty_families();

/// A query for `triangles`, all of size about `size`: far, near, on the
/// surface, on a corner, an ulp beside one, on an edge's middle.
Vec3 nasty_query(Random& random, std::span<const Corners> triangles, double size);

Vec3 operator+(const Vec3& a, const Vec3& b);
Vec3 operator-(const Vec3& a, const Vec3& b);
Vec3 operator*(const Vec3& a, double factor);

/// A point of the unit circle, all around from turn 0 to 1, not quite evenly: by
/// arithmetic alone, because sines may differ from machine to machine.
std::array<double, 2> on_circle(double turn);

/// Every corner times `factor`.
Soup scaled(Soup triangles, double factor);
/// Every corner plus `offset`.
Soup perturbed(Soup triangles, const Vec3& offset);

/// A point of the triangle's plane, inside it where `random` says so.
Vec3 point_on(Random& random, const Corners& triangle);

}  // namespace planetree::oracle
