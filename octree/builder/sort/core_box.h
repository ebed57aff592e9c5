#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "octree/geometry/triangle_distance.h"
#include "planetree/types.h"

namespace planetree::octree {

/// Corners of a sample of a model's triangles: every 2^k-th triangle in the order in which they are
/// added, so that the sample depends on that order alone.
class CornerSample {
 public:
  void add(const Vec3& corner);

  /// The box of the sample, without the outermost kTrimmed of each side of each axis. Nothing if
  /// there are too few triangles to leave any out.
  struct Middle {
    Point lower, upper;
  };
  bool middle(Middle& found) const;

 private:
  static constexpr std::size_t kMaxCorners = 1 << 14;

  std::vector<std::array<double, 3>> corners_;
  std::uint64_t added_ = 0;
  std::uint64_t step_ = 1;  // every step_-th triangle is in the sample; a power of two
};

/// Tells the core of a model, in which nearly all of its triangles are, from a few stray triangles
/// far outside. Coordinates are those of the input.
///
/// Bounds and cells are relative to a box. If that were the box of the strays, they would resolve
/// nothing of the core.
class CoreFinder {
 public:
  /// Maximum share of stray triangles: one in so many.
  static constexpr std::uint64_t kTrianglesPerStray = 64;

  /// lower, upper  the model's box
  CoreFinder(const CornerSample& sample, const Point& lower, const Point& upper);

  /// Whether triangles may be stray. Then call add() for each of the model's, in any order.
  bool may_have_strays() const { return may_have_strays_; }
  void add(const Triangle& triangle);

  struct Core {
    Point lower = Point::Zero(), upper = Point::Zero();  ///< box of all triangles but the strays
    std::uint64_t stray_count = 0;                       ///< triangles that are not in it
    double stray_edge = 0;  ///< see storage::ModelRecord::stray_edge; input's units
  };
  /// Returns the core, after the last triangle. It has no strays if the model is better taken as a
  /// whole.
  Core found() const;

 private:
  const Point model_lower_, model_upper_;
  bool may_have_strays_ = false;
  Point window_lower_ = Point::Zero(), window_upper_ = Point::Zero();
  Core core_;
  std::uint64_t core_count_ = 0;
};

}  // namespace planetree::octree
