#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/builder/mesh/stream/ear_clipper.h"
#include "planetree/types.h"

namespace planetree::octree {

/// What is odd about a polygon that is split into triangles nevertheless.
enum class PolygonFault : std::uint8_t {
  kNone,
  kNotPlanar,  ///< not convex, and its corners are not in one plane: it is split as seen along an
               ///< axis
  kCrossing,   ///< crosses itself: its fan may reach beyond it
  kTooLong,  ///< has more than kMaxCorners corners, or would take long to split: its fan may reach
             ///< beyond it
};

/// Splits polygons into triangles that together are the polygon.
///
/// A polygon is looked at along the axis nearest to its normal. If the fan about corner 0 covers it
/// without overlap, as that of a convex polygon does, the fan is taken: triangles (0, i, i + 1).
/// Otherwise ears are cut (EarClipper). A polygon that crosses itself stays a fan.
///
/// The result depends on the corners alone, and is the same on all machines. Corners may repeat or
/// be collinear, and holes may be joined with the outline by bridges.
class PolygonTriangulator {
 public:
  /// The memory for a polygon is about 70 bytes a corner.
  static constexpr std::uint64_t kMaxCorners = std::uint64_t{1} << 20;

  /// Splits a polygon.
  ///
  /// corners  four to kMaxCorners, finite.
  PolygonFault split(std::span<const Vec3> corners);
  /// Whether the last polygon is split into its fan.
  [[nodiscard]] bool is_fan() const { return triangles_.empty(); }
  /// Otherwise its triangles, two fewer than corners.
  [[nodiscard]] std::span<const CornerTriple> triangles() const { return triangles_; }

 private:
  PolygonFault split_scaled(std::span<const Vec3> corners);
  PolygonFault cut_ears(std::span<const Vec3> corners, PolygonProjection& polygon,
                        const Vec3& normal);

  EarClipper ears_;
  std::vector<CornerTriple> triangles_;
  std::vector<Vec3> scaled_;
};

}  // namespace planetree::octree
