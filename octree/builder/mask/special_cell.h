#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/mask_frame.h"

namespace planetree::octree {

/// A cell in which the surface is the boundary of a convex region: what is on
/// or behind every one of a few planes.
struct SpecialCell {
  unsigned plane_count = 0;
  std::array<Triangle, kMaxPlanes> planes;  ///< the normal (b - a) x (c - a) points beyond
  int behind = 0;                           ///< winding number in the region
  int beyond = 0;                           ///< winding number outside it
};

/// Whether the triangles lie in few enough planes for a special cell, and all
/// have area: what is quick to find out of the first of many.
bool in_few_planes(std::span<const Triangle> triangles);

/// The special cell that a cell is, if it is one.
///
/// triangles  all that touch the closed cell, and possibly others.
/// corners    of the cell, in the order of octants.
/// winding    at the corners, each moved by its infinitesimal step.
///
/// All tests are exact. Why they suffice: every triangle lies in one of the
/// planes and on or behind all others, so the region's inside meets none, and
/// neither does what is beyond a plane. Winding numbers are therefore constant
/// in the one and beyond each plane; one corner strictly behind all planes and
/// one strictly beyond each say what they are. Where they differ, every point of
/// the boundary within the cell has both at hand, and so lies on a triangle.
///
/// source  convex and concave configurations: "Out-of-core real-time haptic
///         interaction on very large models", section 3.2.
std::optional<SpecialCell> special_cell(std::span<const Triangle> triangles,
                                        const std::array<Point, 8>& corners,
                                        const std::array<std::int64_t, 8>& winding);

/// Whether a cell is this special cell: the same arguments, tests and reasons.
bool is_special_cell(const SpecialCell& claim, std::span<const Triangle> triangles,
                     const std::array<Point, 8>& corners,
                     const std::array<std::int64_t, 8>& winding);

}  // namespace planetree::octree
