#pragma once

#include <span>

#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// The greatest distance of a point of the triangles `from` from the triangles `to`, by CGAL. It
/// differs from the true one by at most `error`.
double cgal_hausdorff(std::span<const Corners> from, std::span<const Corners> to, double error);

}  // namespace planetree::oracle
