#pragma once

#include <array>
#include <cstdint>

#include "octree/geometry/child_bounds.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/nearby_lists.h"

/// Tests of a node's children, of a list of subtrees, and of the triangles of a block or of a list,
/// against a box or a point. Results have a bit for each child, subtree or triangle.
namespace planetree::octree {

/// Returns a bit for each child, or subtree, whose box meets `box`.
unsigned children_meeting(const Node& node, const FloatBox& box) noexcept;
std::uint64_t subtrees_meeting(const NearbySubtrees& list, const FloatBox& box) noexcept;

/// Adds to `list` the children of `node` whose boxes are not farther from the query than
/// `threshold` (see prune_threshold()). `list` must have capacity, see
/// NearbySubtrees::has_capacity().
void add_children_within(const Node& node, const FloatQuery& query, float threshold,
                         NearbySubtrees& list) noexcept;

/// Returns the triangles that may be within `distance` of a point; the others are farther. For each
/// triangle returned, `nearest` receives a lower bound on its distance.
///
/// wide  the point rounded to float, see FloatQuery::from()
unsigned triangles_within(const BlockView& block, const Point& point, const FloatQuery& wide,
                          double distance, double (&nearest)[kMaxBlockTriangles]) noexcept;

/// Returns the triangles that may have this corner, as found by one coordinate in float; the others
/// do not have it. A word holds the bits of 64 triangles.
using NearbyTriangleBits = std::array<std::uint64_t, NearbyTriangles::kMax / 64>;
NearbyTriangleBits triangles_with_corner(const NearbyTriangles& list, const Point& corner) noexcept;

/// Tests the triangles of blocks against a box by outcodes, which have one bit for each side of the
/// box that a vertex is beyond, as in Cohen-Sutherland clipping. A vertex closer to a side than
/// float resolves may count as not beyond it.
class Outcodes {
 public:
  /// lower, upper  of the box, model frame
  Outcodes(const Point& lower, const Point& upper) noexcept;

  /// Returns a bit for each triangle with a corner in the box.
  unsigned with_corner_within(const BlockView& block) const noexcept;

 private:
  const Point lower_, upper_;
  float float_lower_[3], float_upper_[3];  // rounded outward
};

/// Finds the octants of a box that the triangles of blocks are near. A vertex closer to a side or
/// to the middle than float resolves may count for both sides of it.
class OctantCodes {
 public:
  /// middle  common corner of the octants; model frame, as all points
  OctantCodes(const Point& lower, const Point& middle, const Point& upper) noexcept;

  struct NearOctants {
    unsigned with_vertex = 0;                 ///< octants that contain vertices
    std::uint8_t by_box[kMaxBlockTriangles];  ///< for each triangle the octants that its box meets
  };
  NearOctants near_octants(const BlockView& block) const noexcept;

  /// Octants for each outcode about the middle. The code has two bits an axis: below the middle,
  /// above it.
  static constexpr auto kOctants = [] {
    constexpr std::array<unsigned, 3> kUpper = {0xaa, 0xcc, 0xf0};
    std::array<std::uint8_t, 64> octants{};
    for (unsigned code = 0; code < 64; ++code) {
      unsigned left = 0xff;
      for (unsigned axis = 0; axis < 3; ++axis) {
        if ((code >> 2 * axis & 1) != 0) left &= ~kUpper[axis];
        if ((code >> 2 * axis & 2) != 0) left &= kUpper[axis];
      }
      octants[code] = static_cast<std::uint8_t>(left);
    }
    return octants;
  }();

 private:
  unsigned code(const Point& greatest, const Point& least) const;

  const Point box_[2], middle_;
  float float_box_[2][3];     // rounded outward
  float float_middle_[2][3];  // rounded down and up
};

}  // namespace planetree::octree
