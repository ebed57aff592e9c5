#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "planetree/types.h"
#include "tools/answers/answer_words.h"
#include "tools/values/value_sketch.h"

namespace planetree::tools {

/// A sum that does not lose small terms. After Neumaier 1974.
class CompensatedSum {
 public:
  void add(double term);
  /// Infinite if it overflows.
  double value() const { return std::isfinite(sum_) ? sum_ + rest_ : sum_; }

 private:
  double sum_ = 0, rest_ = 0;
};

/// A certified interval of the greatest distance of a set of points from the model: the one-sided
/// Hausdorff distance from the set to the model.
struct HausdorffInterval {
  double lower = 0, upper = 0;
  bool is_empty = true;      ///< there is no point yet
  Vec3 at;                   ///< a point of the set that is at least `lower` away
  bool has_nearest = false;  ///< whether the search reached as far
  Vec3 nearest;              ///< the nearest point of the model to it

  /// Takes a point of the set with its answer.
  void add(const Vec3& point, const ClosestPoint& answer);
};

/// Statistics of the deviations of points from a model.
///
/// A deviation is the distance from the nearest point of the model: negative inside, positive
/// outside and where the side is unknown, always positive if sides are left out. A point that is
/// not finite, or beyond the distance to which the model is searched, has none. It is counted and
/// has no part in the statistics.
class DeviationTally {
 public:
  static constexpr std::size_t kPercentiles = 4;
  static constexpr std::array<int, kPercentiles> kPercents = {50, 90, 95, 99};
  static constexpr double kNoDeviation = std::numeric_limits<double>::quiet_NaN();

  /// A point at an end of the range.
  struct Extreme {
    double deviation = 0;
    Vec3 point, nearest;
  };

  /// unit       a length as that of ValueSketch
  /// tolerance  if given, points of greater deviation are counted
  DeviationTally(double unit, bool is_signed, std::optional<double> tolerance)
      : is_signed_(is_signed), tolerance_(tolerance), sketch_(unit) {}

  /// Takes a point with its answer. Returns its deviation, or kNoDeviation.
  ///
  /// weight  of the point, such as the area that it stands for
  double add(const Vec3& point, const ClosestPoint& answer, double weight = 1);

  bool is_signed() const { return is_signed_; }
  std::uint64_t points() const { return points_; }
  std::uint64_t count_of(Status status) const {
    return by_status_[static_cast<std::size_t>(status)];
  }
  std::uint64_t count_of(Side side) const { return by_side_[static_cast<std::size_t>(side)]; }
  /// Points that have a deviation. Statistics are 0 without one.
  std::uint64_t measured() const { return measured_; }
  const Extreme& min() const { return min_; }
  const Extreme& max() const { return max_; }
  double mean() const { return mean_of(sum_); }
  double mean_magnitude() const { return mean_of(sum_of_magnitudes_); }
  double rms() const;
  std::optional<double> tolerance() const { return tolerance_; }
  /// Points beyond the tolerance, and their share of the weight.
  std::uint64_t beyond() const { return beyond_; }
  double share_beyond() const { return mean_of(weight_beyond_); }
  const ValueSketch& sketch() const { return sketch_; }
  const HausdorffInterval& hausdorff() const { return hausdorff_; }

 private:
  double deviation_of(const ClosestPoint& answer) const;
  double mean_of(const CompensatedSum& sum) const {
    return sketch_.weight() > 0 ? sum.value() / sketch_.weight() : 0;
  }

  const bool is_signed_;
  const std::optional<double> tolerance_;
  ValueSketch sketch_;
  HausdorffInterval hausdorff_;
  std::array<std::uint64_t, kStatusCount> by_status_{};
  std::array<std::uint64_t, kSideCount> by_side_{};
  std::uint64_t points_ = 0, measured_ = 0, beyond_ = 0;
  CompensatedSum sum_, sum_of_magnitudes_, sum_of_squares_, weight_beyond_;
  Extreme min_, max_;
};

}  // namespace planetree::tools
