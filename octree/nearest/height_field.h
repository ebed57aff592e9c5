#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "octree/geometry/triangle_distance.h"
#include "octree/nearest/nearest.h"

/// Height fields: parts of a watertight surface that are so simple that the faces at a nearest
/// point tell the side.
///
/// A block in a height field (BlockHeader::is_height_field()) is in a box that reaches beyond the
/// block by kRim or more on all sides. Every line through the box along one direction crosses the
/// surface once, from the outside of the solid to its inside. Each triangle in the box has a
/// normal against that direction (kMinRise) and no thin corner (kMinSine).
///
/// Proof that the faces tell the side. Let x be the point nearest to the query on a triangle of
/// such a block, and let no other triangle be nearer by more than kMaxInterval. Then the segment
/// from x to the query meets no triangle beyond its first kMaxInterval. Let the faces at x be as
/// large as kMinFaceArea requires, and x as far from what ends them. Then only these faces are
/// within that length: a line along the direction through any other triangle there would cross one
/// of them too. Let the query be in front of all faces at x. Then the segment leaves x to the
/// outside. It could enter the solid only through a face that the query is behind, and there is
/// none. So the query is outside. Likewise, it is inside if it is behind all faces at x.
namespace planetree::octree {

struct HeightField {
  /// Minimum cosine of the angle between a triangle's normal and the direction to the outside.
  static constexpr double kMinRise = 0x1p-4;
  /// Minimum sine of a triangle's least angle.
  static constexpr double kMinSine = 0x1p-12;
  /// Minimum distance between a block and the sides of its box; model frame, as all lengths here.
  static constexpr double kRim = 0x1p-30;

  /// Maximum width of the nearest distance's interval.
  static constexpr double kMaxInterval = 0x1p-44;

  /// Whether the faces at a nearest point may tell the side.
  static bool tells_side(const NearestAnswer& nearest) {
    return nearest.is_height_field && nearest.status == Status::kExact &&
           nearest.upper - nearest.lower <= kMaxInterval;
  }
};

/// Tests whether a query is in front of all faces at a nearest point, or behind all of them.
class FacingSides {
 public:
  explicit FacingSides(const Point& query) : query_(query) {}

  /// Adds a face.
  ///
  /// normal  its unit normal, right within 2^-26
  /// area2   square of twice its area
  void add(const Triangle& face, const Point& normal, double area2) {
    const Point way = query_ - face[0];
    const double height = way.dot(normal);
    const double error = kHeightError * way.norm() + kMinHeight;
    const bool certain = std::fabs(height) > error && area2 >= kMinFaceArea * kMinFaceArea;
    in_front_ = in_front_ && certain && height > 0;
    behind_ = behind_ && certain && height < 0;
    any_ = true;
  }
  /// Adds a face whose side is uncertain.
  void add_unknown() { in_front_ = behind_ = false; }
  /// Makes the side uncertain if the nearest point is too near to what ends its feature.
  ///
  /// distance_by_area  inside a face: its least barycentric coordinate times twice the face's area.
  ///                   On an edge: its distance from the nearer end.
  void end_after(double distance_by_area) {
    if (!(distance_by_area >= kMinFaceArea)) add_unknown();
  }

  /// 1: the query is in front of all faces; -1: behind all; 0: neither, or uncertain.
  int common() const { return !any_ ? 0 : in_front_ ? 1 : behind_ ? -1 : 0; }

 private:
  static constexpr double kHeightError = 0x1p-20;
  static constexpr double kMinHeight = 0x1p-36;
  /// Minimum of twice a face's area and of end_after()'s argument. No side is longer than 4. So a
  /// corner is at least 2^-34 from the side opposite, and a point inside a face from every side.
  static constexpr double kMinFaceArea = 0x1p-32;

  const Point& query_;
  bool any_ = false;
  bool in_front_ = true;
  bool behind_ = true;
};

}  // namespace planetree::octree
