#pragma once

#include <algorithm>
#include <limits>

#include "planetree/scene.h"
#include "planetree/types.h"

namespace planetree::query {

/// The first of what instances answer about a way: the answer of least t and, where these are
/// equal, of the instance added first; with bounds of t over all of them.
///
/// Answer  RayHit or FirstContact
template <class Answer>
class EarliestAnswer {
 public:
  void offer(const Answer& answer, InstanceId instance) noexcept {
    lower_ = std::min(lower_, answer.t_lower);
    upper_ = std::min(upper_, answer.t_upper);
    if (answer.status == Status::kBeyondMaxDistance)
      is_beyond_ = true;
    else if (answer.status != Status::kExact)
      unproven_ = std::min(unproven_, answer.t_lower);
    if (has_answer_ && answer.t >= best_.t && !(answer.t == best_.t && instance < instance_))
      return;
    best_ = answer;
    instance_ = instance;
    has_answer_ = true;
  }
  /// Notes that max_distance ends the way at t before instances that were not asked.
  void end_at(double t) noexcept {
    lower_ = std::min(lower_, t);
    is_beyond_ = true;
  }

  bool has_answer() const noexcept { return has_answer_; }
  const Answer& best() const noexcept { return best_; }
  InstanceId instance() const noexcept { return is_found() ? instance_ : kNoInstance; }
  /// Whether something is hit or touched.
  bool is_found() const noexcept { return best_.t < kInfinity; }
  double lower() const noexcept { return lower_; }
  double upper() const noexcept { return upper_; }
  Status status() const noexcept {
    if (unproven_ < kInfinity && unproven_ <= std::min(best_.t, upper_)) return Status::kDegraded;
    return is_beyond_ && !is_found() ? Status::kBeyondMaxDistance : Status::kExact;
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  Answer best_;
  InstanceId instance_ = kNoInstance;
  bool has_answer_ = false, is_beyond_ = false;
  double lower_ = kInfinity, upper_ = kInfinity;  // of t
  double unproven_ = kInfinity;  // t before which the instances that are not exact are free
};

}  // namespace planetree::query
