#pragma once

#include <cmath>

namespace planetree::octree {

/// Running sum of doubles with a bound on its rounding error. It keeps what each addition loses, so
/// that the error stays small over a great many terms, also when terms are subtracted again.
///
/// source  Neumaier 1974; the error bound is our own
class CertainSum {
 public:
  void add(double term) {
    const double next = high_ + term;
    // Rounding error of `next`. It is exact when the thread rounds to nearest; in a directed mode
    // it errs by at most kSumLostRounding |next|.
    const double lost =
        std::fabs(high_) >= std::fabs(term) ? (high_ - next) + term : (term - next) + high_;
    high_ = next;
    low_ += lost;
    slack_ += kSumLowRounding * std::fabs(low_) + kSumLostRounding * std::fabs(next);
  }

  double value() const { return high_ + low_; }
  /// |value() - true sum| is at most this.
  double error() const { return kSumSlackInflation * slack_ + kSumLowRounding * std::fabs(high_); }

 private:
  /// Relative error of one addition, in any rounding mode.
  static constexpr double kSumLowRounding = 0x1p-52;
  /// What the rounding error of an addition may err by, as a share of the sum. The error is at most
  /// 2^-52 of the sum and, where the mode is not to nearest, is rounded by as much.
  static constexpr double kSumLostRounding = 0x1p-104;
  /// Rounding of slack_ itself: one in a hundred is reached after 9e13 additions.
  static constexpr double kSumSlackInflation = 1.01;

  double high_ = 0;
  double low_ = 0;
  double slack_ = 0;
};

}  // namespace planetree::octree
