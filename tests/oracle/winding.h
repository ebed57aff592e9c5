#pragma once

#include <cstdint>
#include <span>

#include "planetree/types.h"
#include "tests/oracle/brute_force.h"

/// Winding numbers by brute force, by methods that the library does not use: solid angles, and rays
/// in directions other than the axes.
namespace planetree::oracle {

/// The winding number of triangles about a point, as a sum of solid angles in long double (Van
/// Oosterom & Strackee 1983). The error is about 1e-15 times the number of triangles, except within
/// rounding of the surface.
long double solid_angle_winding(const Vec3& query, std::span<const Corners> triangles);

/// The winding number of any triangles about a point. The error is 1e-15 times their number,
/// wherever the point is.
struct OpenWinding {
  long double value = 0;    ///< without the triangles that the point is on
  bool on_surface = false;  ///< the point is on a triangle
};

/// Sums solid angles in long double. Where that is uncertain, their signs are computed in integers
/// and their sizes with as many bits as needed.
OpenWinding open_winding(const Vec3& query, std::span<const Corners> triangles);

/// The same in double, without an arctangent for each triangle: fast enough for millions of
/// triangles. Off by a whole number or by a half within rounding of the surface.
double quick_winding(const Vec3& query, std::span<const Corners> triangles);

/// The side of a point by the winding number of a watertight surface. Found without any error by
/// signed crossings of a ray: in long double where that is certain, in integers elsewhere. Never
/// kUnknown.
Side exact_side(const Vec3& query, std::span<const Corners> triangles);

}  // namespace planetree::oracle
