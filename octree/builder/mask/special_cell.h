#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/mask_frame.h"

namespace planetree::octree {

/// A cell in which the surface is the boundary of a convex set: the points that are on or behind
/// every one of a few planes.
struct SpecialCell {
  unsigned plane_count = 0;
  std::array<Triangle, kMaxPlanes> planes;  ///< the normal (b - a) x (c - a) points beyond
  int behind = 0;                           ///< winding number in the set
  int beyond = 0;                           ///< winding number outside it
};

/// Whether the triangles all have area and lie in few enough planes for a special cell. This is
/// quick to find out, and a few of many triangles usually decide it.
bool in_few_planes(std::span<const Triangle> triangles);

/// The special cell that a cell is; nothing if it is none.
///
/// triangles  all that touch the closed cell, and possibly others.
/// corners    corners of the cell, in the order of octants.
/// winding    numbers at the perturbed corners.
///
/// All tests are exact. They suffice for this reason: every triangle lies in one of the planes and
/// on or behind all others, so that no triangle is inside of the set or beyond a plane. Winding
/// numbers are therefore constant inside of the set and beyond each plane. A corner strictly behind
/// all planes and a corner strictly beyond each plane tell the numbers. Where the numbers differ,
/// every point of the set's boundary within the cell is a limit of points with either number, and
/// so lies on a triangle.
///
/// source  convex and concave configurations: "Out-of-core real-time haptic interaction on very
///         large models", section 3.2.
std::optional<SpecialCell> special_cell(std::span<const Triangle> triangles,
                                        const std::array<Point, 8>& corners,
                                        const std::array<std::int64_t, 8>& winding);

/// Whether a cell is the special cell `claim`, by the arguments and tests of special_cell().
bool is_special_cell(const SpecialCell& claim, std::span<const Triangle> triangles,
                     const std::array<Point, 8>& corners,
                     const std::array<std::int64_t, 8>& winding);

}  // namespace planetree::octree
