#pragma once

#include <cstdint>
#include <span>

#include "planetree/types.h"
#include "tests/oracle/brute_force.h"

/// Winding numbers by looking at every triangle, in ways that the library does
/// not go: solid angles, and rays in any direction but along an axis.
namespace planetree::oracle {

/// The winding number of triangles about a point, as a sum of solid angles in
/// long double (Van Oosterom & Strackee 1983): right to some 1e-15 of the
/// number of triangles, except within rounding of the surface.
long double solid_angle_winding(const Vec3& query, std::span<const Corners> triangles);

/// The winding number about a point of any triangles, to 1e-15 of their number
/// wherever the point is.
struct OpenWinding {
  long double value = 0;    ///< triangles that the point is on left out
  bool on_surface = false;  ///< it is on one
};

/// Solid angles in long double; where that is uncertain, their signs in
/// fractions and their sizes in as many bits as it takes.
OpenWinding open_winding(const Vec3& query, std::span<const Corners> triangles);

/// The same in double and without an arctangent for each triangle: for millions
/// of them. Wrong by a whole number or a half within rounding of the surface.
double quick_winding(const Vec3& query, std::span<const Corners> triangles);

/// The side a point is on by the winding number of a watertight surface, found
/// without any error by signed crossings of a ray: long double where that is
/// certain, integers elsewhere. Never kUnknown.
Side exact_side(const Vec3& query, std::span<const Corners> triangles);

}  // namespace planetree::oracle
