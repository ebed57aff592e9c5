#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "octree/geometry/triangle_distance.h"
#include "octree/nearest/nearest.h"

/// Parts of a watertight surface that are simple enough for a nearest triangle to tell a side.
///
/// About a block in a sheet (BlockHeader::is_height_field()) there is a direction such that every
/// line along it, within a box that goes on for kRim on all sides of the block, crosses the surface
/// once: from the outside of the solid to its inside. All triangles in the box rise in that
/// direction and are no needles.
///
/// Let x be the point of a triangle of such a block that is nearest to a query, and all others
/// nearer by less than kMaxError, if at all. Then nothing crosses the way from x to the query but
/// in its first kMaxError. There, where faces at x are as large as told here and x is as far from
/// what ends them, are those faces alone: whatever else was so near would be crossed by a line
/// that crosses one of them. If all have the query in front, the way leaves x to the outside, and
/// from there could cross but a face whose back is to the query: there is none. So the query is
/// outside; and inside if it is behind all of them.
namespace planetree::octree {

struct HeightField {
  /// The least share of triangles' normals along the direction, and the least sine of their
  /// thinnest corner.
  static constexpr double kMinRise = 0x1p-4;
  static constexpr double kMinSine = 0x1p-12;
  static constexpr double kRim = 0x1p-30;  ///< model frame, as all lengths here

  /// Between the bounds of a nearest distance.
  static constexpr double kMaxError = 0x1p-44;

  /// Whether faces at a nearest point may tell the side.
  static bool tells_side(const NearestAnswer& nearest) {
    return nearest.is_height_field && nearest.status == Status::kExact &&
           nearest.upper - nearest.lower <= kMaxError;
  }
};

/// On which side of all faces at a nearest point a query is.
class FacingSides {
 public:
  explicit FacingSides(const Point& query) : query_(query) {}

  /// A face by its unit normal, right within 2^-26, and twice its area, squared.
  void add(const Triangle& face, const Point& normal, double area2) {
    const Point way = query_ - face[0];
    const double height = way.dot(normal);
    const double error = kHeightError * way.norm() + kMinHeight;
    const bool certain = std::fabs(height) > error && area2 >= kMinArea * kMinArea;
    in_front_ = in_front_ && certain && height > 0;
    behind_ = behind_ && certain && height < 0;
    any_ = true;
  }
  /// A face of which nothing can be told.
  void add_unknown() { in_front_ = behind_ = false; }
  /// How far the nearest point is from what ends its face, times twice the face's area; or from
  /// the ends of its edge.
  void end_after(double distance_by_area) {
    if (!(distance_by_area >= kMinArea)) add_unknown();
  }

  /// 1: in front of all of them; -1: behind; 0: neither, or too near to tell.
  int common() const { return !any_ ? 0 : in_front_ ? 1 : behind_ ? -1 : 0; }

 private:
  static constexpr double kHeightError = 0x1p-20;
  static constexpr double kMinHeight = 0x1p-36;
  /// Of twice a face's area: no side is longer than 4, so that its corners are 2^-34 from the
  /// sides opposite to them at least.
  static constexpr double kMinArea = 0x1p-32;

  const Point& query_;
  bool any_ = false;
  bool in_front_ = true;
  bool behind_ = true;
};

}  // namespace planetree::octree
