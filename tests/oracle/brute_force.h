#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include "planetree/types.h"

/// Nearest triangles by looking at every one, in arithmetic that the library
/// does not use and by another method: the seven Voronoi regions of a triangle
/// (Ericson, Real-Time Collision Detection, 5.1.5).
namespace planetree::oracle {

using Corners = std::array<Vec3, 3>;

/// 512 bits and exponents without an end in practice: holds a distance to
/// 1e-150 of itself.
using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<512, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

/// Distance in long double: right to some 1e-17 of the farthest corner on
/// triangles that are not needles.
long double extended_distance(const Vec3& query, const Corners& triangle);

/// A squared distance as the fraction numerator / denominator * 4^exponent of
/// integers: without any error.
struct ExactSquare {
  boost::multiprecision::cpp_int numerator = 0;
  boost::multiprecision::cpp_int denominator = 1;
  int exponent = 0;

  /// The distance itself.
  [[nodiscard]] Wide root() const;
};

/// The exact squared distance; finite doubles of any size.
ExactSquare exact_square(const Vec3& query, const Corners& triangle);

/// The exact distance to the nearest of `triangles`, which are not none.
/// Triangles that some long double bound excludes by far are not looked at.
Wide exact_distance(const Vec3& query, std::span<const Corners> triangles);

/// The same in long double, of every triangle.
long double extended_distance(const Vec3& query, std::span<const Corners> triangles);

}  // namespace planetree::oracle
