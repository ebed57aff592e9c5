#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>

#include "planetree/contact.h"
#include "tests/oracle/brute_force.h"

/// Rays and moving balls against one triangle. Rays are judged in rationals. Balls are judged by
/// the distance between the way of the centre and the triangle, as the least of the distances of
/// segments and of points from faces; the library's searches for a time do not occur.
namespace planetree::oracle {

using Rational = boost::multiprecision::cpp_rational;
using Quad = boost::multiprecision::cpp_bin_float_quad;

/// How a line meets a closed triangle.
enum class Meeting {
  kMisses,   ///< no common point
  kPasses,   ///< through its interior, from one side of its plane to the other
  kTouches,  ///< through an edge or a corner, or within its plane
};

struct LineMeeting {
  Meeting meeting = Meeting::kMisses;
  Rational t;  ///< only if it passes, or touches from outside of the plane
  bool has_t = false;
  bool entering = false;  ///< only if it passes
};

/// How the whole line of a ray meets a triangle, whatever t_min and t_max are.
LineMeeting meet(const Vec3& origin, const std::array<Rational, 3>& direction,
                 const Corners& triangle);

/// The difference of two points, without rounding.
std::array<Rational, 3> exact_difference(const Vec3& to, const Vec3& from);

/// Returns the sign of (distance between a triangle and the way up to t) - radius, 0 where the
/// difference is below 1e-27 of the coordinates.
int compare_way(const Sweep& sweep, double t, const Corners& triangle);

}  // namespace planetree::oracle
