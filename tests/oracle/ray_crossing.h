#pragma once

#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// How the ray from `query` along +x passes a triangle: 1 where it leaves through its front,
/// -1 where it enters through it, 0 where it misses. Without any error (CGAL's exact
/// predicates). The ray goes an infinitesimal step aside, so that it meets no edge: of a
/// watertight surface that the query is not on, the sum is the winding number. Of a triangle
/// that the query is on, 0.
int ray_crossing(const Vec3& query, const Corners& triangle);

}  // namespace planetree::oracle
