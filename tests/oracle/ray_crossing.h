#pragma once

#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// Crossing of a triangle by the ray from `query` along +x: 1 if the ray leaves through its front,
/// -1 if it enters through it, 0 if it misses. Without any error (CGAL's exact predicates). The ray
/// is moved aside infinitesimally, so that it meets no edge. For a watertight surface that the
/// query is not on, the sum over all triangles is the winding number. 0 for a triangle that the
/// query is on.
int ray_crossing(const Vec3& query, const Corners& triangle);

}  // namespace planetree::oracle
