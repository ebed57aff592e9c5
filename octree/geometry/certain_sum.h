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
    // it errs by at most 2^-104 |next|.
    const double lost =
        std::fabs(high_) >= std::fabs(term) ? (high_ - next) + term : (term - next) + high_;
    high_ = next;
    low_ += lost;
    slack_ += 0x1p-52 * std::fabs(low_) + 0x1p-104 * std::fabs(next);
  }

  double value() const { return high_ + low_; }
  /// |value() - true sum| is at most this.
  double error() const { return 1.01 * slack_ + 0x1p-52 * std::fabs(high_); }

 private:
  double high_ = 0;
  double low_ = 0;
  double slack_ = 0;
};

}  // namespace planetree::octree
