#pragma once

#include <cstddef>
#include <vector>

namespace planetree::tools {

/// The distribution of any number of values in 1 MiB: weights in bins, 1024 for each power of two.
/// So a quantile differs from the exact one by at most kRelativeError of it, or by 2^-40 of the
/// unit if that is more. The last bin has all values of 2^24 units or more, and their greatest
/// stands for them.
class ValueSketch {
 public:
  static constexpr double kRelativeError = 0x1p-11;

  /// unit  a length in the order of the greatest values, finite and > 0, such as the diagonal of a
  ///       model
  explicit ValueSketch(double unit);

  /// value   finite
  /// weight  finite and >= 0
  void add(double value, double weight = 1);

  /// Sum of all weights.
  double weight() const { return weight_; }
  /// Extremes, exact. 0 without a value.
  double min() const { return min_; }
  double max() const { return max_; }
  /// The least value such that it and lesser values have this share of the weight. 0 without one.
  double quantile(double share) const;
  /// The same of the values without their signs.
  double quantile_of_magnitude(double share) const;

  /// Shares of the weight in bins of equal width.
  struct Histogram {
    double lower = 0, upper = 0;
    double below = 0, above = 0;  ///< shares of what lies outside
    std::vector<double> shares;
  };
  /// Values within kRelativeError of the edge of a bin may count to its neighbour.
  ///
  /// lower, upper  of the first and the last bin; lower < upper
  Histogram histogram(double lower, double upper, std::size_t bins) const;

 private:
  // Bins of magnitudes; values below 2^-40 units are in the first.
  static constexpr int kMinExponent = -40, kEndExponent = 24;
  static constexpr int kBinBits = 10;
  static constexpr std::size_t kBins = std::size_t{kEndExponent - kMinExponent} << kBinBits;

  std::size_t bin_of(double magnitude) const;
  double middle_of(std::size_t bin) const;

  int unit_exponent_;
  std::vector<double> negative_, positive_;  // weights; zero is positive
  double weight_ = 0, min_ = 0, max_ = 0;
  bool is_empty_ = true;
};

}  // namespace planetree::tools
