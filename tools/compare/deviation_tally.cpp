#include "tools/compare/deviation_tally.h"

#include <algorithm>
#include <cmath>

namespace planetree::tools {

void CompensatedSum::add(double term) {
  const double sum = sum_ + term;
  rest_ += std::fabs(sum_) >= std::fabs(term) ? sum_ - sum + term : term - sum + sum_;
  sum_ = sum;
}

void HausdorffInterval::add(const Vec3& point, const ClosestPoint& answer) {
  upper = std::max(upper, answer.upper);
  if (!is_empty && answer.lower <= lower) return;
  is_empty = false;
  lower = answer.lower;
  at = point;
  has_nearest = std::isfinite(answer.distance);
  nearest = answer.point;
}

double DeviationTally::deviation_of(const ClosestPoint& answer) const {
  if (!std::isfinite(answer.distance)) return kNoDeviation;
  // 0 has no sign, as on the surface.
  if (!is_signed_ || answer.distance == 0) return answer.distance;
  return answer.signed_distance();
}

double DeviationTally::add(const Vec3& point, const ClosestPoint& answer, double weight) {
  ++points_;
  ++by_status_[static_cast<std::size_t>(answer.status)];
  if (answer.status == Status::kBadQuery) return kNoDeviation;
  if (is_signed_) ++by_side_[static_cast<std::size_t>(answer.side)];
  hausdorff_.add(point, answer);
  const double deviation = deviation_of(answer);
  const double magnitude = std::fabs(deviation);
  if (tolerance_ && (answer.status == Status::kBeyondMaxDistance || magnitude > *tolerance_))
    ++beyond_;
  if (std::isnan(deviation)) return deviation;
  ++measured_;
  if (measured_ == 1 || deviation < min_.deviation) min_ = {deviation, point, answer.point};
  if (measured_ == 1 || deviation > max_.deviation) max_ = {deviation, point, answer.point};
  sketch_.add(deviation, weight);
  sum_.add(weight * deviation);
  sum_of_magnitudes_.add(weight * magnitude);
  sum_of_squares_.add(weight * magnitude * magnitude);
  if (tolerance_ && magnitude > *tolerance_) weight_beyond_.add(weight);
  return deviation;
}

double DeviationTally::rms() const { return std::sqrt(mean_of(sum_of_squares_)); }

}  // namespace planetree::tools
