#pragma once

#include <cmath>

namespace planetree::octree {

/// A running sum of doubles that knows what its rounding may have cost: the
/// sum of a great many terms, and terms taken away again, leave no trace
/// (Neumaier 1974; the bound of what is left is ours).
class CertainSum {
 public:
  void add(double term) {
    const double next = high_ + term;
    // What `next` has lost, without error; to nearest even or not.
    const double lost =
        std::fabs(high_) >= std::fabs(term) ? (high_ - next) + term : (term - next) + high_;
    high_ = next;
    low_ += lost;
    slack_ += 0x1p-52 * std::fabs(low_) + 0x1p-104 * std::fabs(next);
  }

  double value() const { return high_ + low_; }
  /// The true sum is within this of value().
  double error() const { return 1.01 * slack_ + 0x1p-52 * std::fabs(high_); }

 private:
  double high_ = 0;
  double low_ = 0;
  double slack_ = 0;
};

}  // namespace planetree::octree
