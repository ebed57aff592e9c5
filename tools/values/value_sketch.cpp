#include "tools/values/value_sketch.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>

namespace planetree::tools {
namespace {

constexpr int kMantissaBits = 52;
constexpr int kExponentBias = 1023;

}  // namespace

ValueSketch::ValueSketch(double unit) : negative_(kBins), positive_(kBins) {
  assert(std::isfinite(unit) && unit > 0);
  std::frexp(unit, &unit_exponent_);
}

// The exponent and the first bits of the fraction, read as one number, count the bins.
std::size_t ValueSketch::bin_of(double magnitude) const {
  const double scaled = std::ldexp(magnitude, -unit_exponent_);
  if (scaled < std::ldexp(1.0, kMinExponent)) return 0;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(scaled) >> (kMantissaBits - kBinBits);
  constexpr std::uint64_t kFirst = std::uint64_t{kExponentBias + kMinExponent} << kBinBits;
  return std::min<std::uint64_t>(bits - kFirst, kBins - 1);
}

double ValueSketch::middle_of(std::size_t bin) const {
  if (bin == 0) return 0;
  constexpr std::size_t kPerExponent = std::size_t{1} << kBinBits;
  const int exponent = kMinExponent + static_cast<int>(bin / kPerExponent);
  const double fraction =
      1 + (static_cast<double>(bin % kPerExponent) + 0.5) / static_cast<double>(kPerExponent);
  return std::ldexp(fraction, exponent + unit_exponent_);
}

void ValueSketch::add(double value, double weight) {
  assert(std::isfinite(value) && weight >= 0);
  min_ = is_empty_ ? value : std::min(min_, value);
  max_ = is_empty_ ? value : std::max(max_, value);
  is_empty_ = false;
  weight_ += weight;
  (value < 0 ? negative_ : positive_)[bin_of(std::fabs(value))] += weight;
}

double ValueSketch::quantile(double share) const {
  if (is_empty_) return 0;
  const double wanted = share * weight_;
  double sum = 0;
  for (std::size_t bin = kBins; bin-- > 0;) {
    sum += negative_[bin];
    if (negative_[bin] > 0 && sum >= wanted)
      return bin == kBins - 1 ? min_ : std::clamp(-middle_of(bin), min_, max_);
  }
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    sum += positive_[bin];
    if (positive_[bin] > 0 && sum >= wanted)
      return bin == kBins - 1 ? max_ : std::clamp(middle_of(bin), min_, max_);
  }
  return max_;
}

double ValueSketch::quantile_of_magnitude(double share) const {
  if (is_empty_) return 0;
  const double greatest = std::max(std::fabs(min_), std::fabs(max_));
  double sum = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    const double weight = negative_[bin] + positive_[bin];
    sum += weight;
    if (weight > 0 && sum >= share * weight_)
      return bin == kBins - 1 ? greatest : std::min(middle_of(bin), greatest);
  }
  return greatest;
}

ValueSketch::Histogram ValueSketch::histogram(double lower, double upper, std::size_t bins) const {
  assert(lower < upper && bins > 0);
  Histogram made{lower, upper, 0, 0, std::vector<double>(bins)};
  if (weight_ == 0) return made;
  const double per_width = static_cast<double>(bins) / (upper - lower);
  const auto add = [&](double value, double weight) {
    value = std::clamp(value, min_, max_);
    const auto bin =
        static_cast<std::size_t>((std::clamp(value, lower, upper) - lower) * per_width);
    double& to = value < lower   ? made.below
                 : value > upper ? made.above
                                 : made.shares[std::min(bin, bins - 1)];
    to += weight;
  };
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    if (negative_[bin] > 0) add(-middle_of(bin), negative_[bin]);
    if (positive_[bin] > 0) add(middle_of(bin), positive_[bin]);
  }
  for (double& share : made.shares) share /= weight_;
  made.below /= weight_;
  made.above /= weight_;
  return made;
}

}  // namespace planetree::tools
