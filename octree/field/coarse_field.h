#pragma once

#include <cstddef>
#include <limits>
#include <span>

#include "octree/field/field_shape.h"
#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// What the field tells of a query. [lower, upper] holds the distance to the surface.
struct FieldBounds {
  double lower = 0;
  double upper = std::numeric_limits<double>::infinity();
  /// The stored surface point that gives `upper`; off the surface by at most the field's
  /// uncertainty. Zero if the field tells nothing.
  Point point = Point::Zero();

  bool are_known() const { return upper < std::numeric_limits<double>::infinity(); }
};

/// Bounds the distance to a surface by the surface points nearest to the points of a grid.
///
/// Upper bound: a surface point is no nearer than the nearest one. Lower bound: let d(x) be the
/// distance at x. d(x)^2 - |x|^2 is the least of one linear function for each surface point, so it
/// is concave: within a cell it is at least its interpolation between the cell's corners. With
/// trilinear weights w_i, a step h and the position t of x in the cell,
///
///     d(x)^2 >= sum w_i d_i^2 - h^2 sum t (1 - t).
///
/// Both ends err by the square of the step over the distance, so that few points suffice far from
/// the surface. Outside of the grid, which holds the core, the bound of the nearest point p of the
/// grid's box is used: d(x)^2 >= |x - p|^2 + d(p)^2. It does not hold where a stray is.
///
/// Filled once; then any thread may ask it. No page is read.
/// source  planetree's own; concavity as in the lifting map of Edelsbrunner & Seidel 1986.
class CoarseField {
 public:
  /// A field that tells nothing.
  CoarseField() = default;

  /// points      of `shape`, in its order; must outlive this. None: the field tells nothing.
  /// has_strays  whether some triangle is outside of the core.
  void fill(const FieldShape& shape, std::span<const FieldPoint> points, bool has_strays);

  bool is_empty() const { return points_ == nullptr; }

  /// Bounds the distance by the points around a query; `query` is finite, in the model frame.
  FieldBounds bounds(const Point& query) const;

  /// Bound and estimate that one grid point gives.
  struct Estimate {
    double upper = std::numeric_limits<double>::infinity();  ///< bound on the distance
    double width = std::numeric_limits<double>::infinity();  ///< about the width of bounds()
    double lower = 0;                                        ///< about the lower end of bounds()
  };
  /// Looks at the grid point next to a query: a tenth of the work of bounds().
  Estimate estimate(const Point& query) const;
  /// Bounds the distance from above as estimate() does, and tells the surface point. bounds() errs
  /// by more far away, where its upper end may exceed this.
  FieldBounds upper_bound(const Point& query) const;

 private:
  // The grid point next to a query, `steps` from the first one, and the distance of its stored
  // surface point.
  struct Next {
    const FieldPoint* stored;
    double reach;
  };
  Next next_to(const Point& steps) const;

  FieldShape shape_;
  const FieldPoint* points_ = nullptr;
  double steps_per_unit_ = 0;
  double quanta_per_step_ = 0;
  Point last_ = Point::Zero();  // greatest grid point, in steps
  bool has_strays_ = false;
};

}  // namespace planetree::octree
