#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include "planetree/types.h"

/// Distances to the nearest triangle by brute force. Arithmetic and method differ from the
/// library's: the seven Voronoi regions of a triangle (Ericson, Real-Time Collision Detection,
/// 5.1.5).
namespace planetree::oracle {

using Corners = std::array<Vec3, 3>;

/// 512 bits and practically unlimited exponents: represents a distance to a relative error of
/// 1e-150.
using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<512, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

/// Distance in long double. On triangles that are not needles the error is about 1e-17 of the
/// distance of the farthest corner.
long double extended_distance(const Vec3& query, const Corners& triangle);

/// A squared distance as the fraction numerator / denominator * 4^exponent of integers, without any
/// error.
struct ExactSquare {
  boost::multiprecision::cpp_int numerator = 0;
  boost::multiprecision::cpp_int denominator = 1;
  int exponent = 0;

  /// The distance itself.
  [[nodiscard]] Wide root() const;
};

/// The exact squared distance, for finite doubles of any size.
ExactSquare exact_square(const Vec3& query, const Corners& triangle);

/// The exact distance to the nearest of `triangles`, which must not be empty. Triangles that bounds
/// in long double exclude by a margin are not evaluated.
Wide exact_distance(const Vec3& query, std::span<const Corners> triangles);

/// The same in long double, over every triangle.
long double extended_distance(const Vec3& query, std::span<const Corners> triangles);

}  // namespace planetree::oracle
