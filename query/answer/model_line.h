#pragma once

#include "octree/geometry/line_crossing.h"
#include "octree/geometry/triangle_distance.h"
#include "planetree/contact.h"
#include "query/answer/model_geometry.h"
#include "query/file/scale.h"

namespace planetree::query {

/// Returns whether a ray or a sweep can be answered. If not, its status is kBadQuery.
bool is_valid(const Ray& ray);
bool is_valid(const Sweep& sweep);

/// A straight way in the model frame, that of a ray or of the centre of a moving ball. Positions on
/// it are those of the caller times 2^exponent, so that neither coordinates nor positions are
/// rounded.
class ModelLine {
 public:
  ModelLine(const Scale& scale, const Ray& ray);
  ModelLine(const Scale& scale, const Sweep& sweep);

  const octree::Line& line() const { return line_; }
  /// All positions asked for.
  const octree::LineRange& range() const { return range_; }
  /// Whether coordinates exceed octree::kMaxQueryCoordinate.
  bool is_far() const { return is_far_; }

  /// Ends the way after a length; model frame, may be infinite. Returns whether that shortens it.
  bool end_after(double length);
  /// Returns the positions at which the way is within `margin` of a box; `lower` is greater than
  /// `upper` if there are none.
  octree::LineRange within(const octree::Point& lower, const octree::Point& upper,
                           double margin) const;

  /// Returns the point at a position, which errs by error_at() at most.
  octree::Point at(double position) const { return line_.origin + position * line_.direction(); }
  double error_at(double position) const;
  /// Returns an upper bound on the length of the way from one position to a later one.
  double length_between(double from, double to) const;
  /// Returns a lower bound on the position that is reached from `from` after a length.
  double position_after(double from, double length) const;

  /// Converts a position of the range to the caller's, in the range that the caller gave.
  double out(double position) const;
  /// Converts a bound on a position.
  double out_below(double position) const;
  double out_above(double position) const;

 private:
  octree::Line line_;
  octree::LineRange given_;  // the caller's positions
  octree::LineRange range_;
  int exponent_ = 0;
  double speed_;  // upper bound on the length of the way for each unit of position
  bool is_far_;
};

/// Returns the distance from the start of the way for which no triangle that is missing from the
/// file comes within `margin` of it; infinity if none does up to `end`, a position.
double clear_length(const ModelGeometry& model, const ModelLine& way, double end, double margin);

}  // namespace planetree::query
