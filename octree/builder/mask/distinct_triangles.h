#pragma once

#include <vector>

#include "octree/builder/sort/triangles.h"
#include "octree/builder/surface/edge_crossings.h"

namespace planetree::octree {

/// Triangles without their copies: of those that have the same corners in the same order, the first
/// stands for all.
///
/// triangles  sorted by code, as copies have the same code.
std::vector<BoxedTriangle> distinct(const Triangles& triangles);

}  // namespace planetree::octree
