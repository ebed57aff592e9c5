#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "planetree/types.h"

namespace planetree::octree {

/// Boxes, one array for each coordinate of their corners: lower x, y, z, upper x, y, z.
using BoxColumns = std::array<std::span<double>, 6>;

/// Computes the squared distances from a point to the first squared.size() boxes. Each errs by less
/// than 2^-50 of itself, and by 2^-1074 if it underflows. What overflows is the largest double.
void squared_box_distances(const BoxColumns& boxes, const Vec3& point, std::span<double> squared);

/// Returns the least value; infinity if there is none.
double least_value(std::span<const double> values);

}  // namespace planetree::octree
