#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "planetree/point_shell.h"
#include "planetree/types.h"

namespace planetree::query {

/// How depths follow from distances, and how signed distances change where a point moves.
enum class SignRule : std::uint8_t {
  /// The distance counts as that of a point outside. No side is needed.
  kUnsigned,
  /// The sign changes on the surface only, so that the signed distance changes by at most the way
  /// that a point moves.
  kContinuous,
  /// The sign may change anywhere: beside the holes of a surface, and behind the border of a sheet.
  kByPoint,
};

/// What is known of the signed distance of a point, which is negative inside.
struct SignedBounds {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  double lower = -kInfinity;  ///< of the signed distance
  double upper = kInfinity;   ///< of the signed distance
  double gap = 0;             ///< lower bound of its magnitude: of the distance
  double best = kInfinity;    ///< the best known signed distance; infinite: none

  /// The bounds that an answer gives. If it has no side, `side` is kUnknown.
  static SignedBounds of(const ClosestPoint& answer, Side side, SignRule rule) {
    const bool is_inside = side == Side::kInside && rule != SignRule::kUnsigned;
    const bool is_outside = side == Side::kOutside || rule == SignRule::kUnsigned;
    return {is_outside ? answer.lower : -answer.upper, is_inside ? -answer.lower : answer.upper,
            answer.lower, is_inside ? -answer.distance : answer.distance};
  }

  double width() const { return upper - lower; }
  /// Whether the point is certainly inside, or certainly outside.
  bool knows_side() const { return lower > 0 || upper < 0; }

  /// The bounds of a point that is at most `way` away.
  SignedBounds moved(double way, SignRule rule) const {
    const double farthest = std::max(-lower, upper);
    const bool is_continuous = rule != SignRule::kByPoint;
    const double from = is_continuous ? lower : -farthest, to = is_continuous ? upper : farthest;
    SignedBounds other{rounded_down(from - way), rounded_up(to + way),
                       std::max(0.0, rounded_down(gap - way)), best};
    if (rule == SignRule::kUnsigned) other.lower = std::max(other.lower, 0.0);
    return other;
  }
  /// Takes what other bounds of the same point add.
  void meet(const SignedBounds& other) {
    if (std::isinf(best) || other.width() < width()) best = other.best;
    lower = std::max(lower, other.lower);
    upper = std::min(upper, other.upper);
    gap = std::max(gap, other.gap);
    // On the known side the distance is the magnitude.
    if (lower > -gap) lower = std::max(lower, gap);
    if (upper < gap) upper = std::min(upper, -gap);
    gap = std::max({gap, lower, -upper});
  }
  /// Takes a side that is known. On the surface it adds nothing.
  void meet(Side side) {
    if (side == Side::kOutside) lower = std::max(lower, gap);
    if (side == Side::kInside) {
      upper = std::min(upper, -gap);
      best = -std::fabs(best);
    }
  }

 private:
  static double rounded_down(double end) { return end - octree::kEndRounding * std::fabs(end); }
  static double rounded_up(double end) { return end + octree::kEndRounding * std::fabs(end); }
};

}  // namespace planetree::query
