#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "planetree/types.h"

namespace planetree::oracle {

/// Numbers that are the same everywhere (SplitMix64).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return z ^ z >> 31;
  }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(bits() % count); }
  /// In [0, 1).
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  double either_sign() { return between(-1, 1); }
  /// Of any order of magnitude between 2^low and 2^high.
  double magnitude(double low, double high) { return std::exp2(between(low, high)); }
  bool one_in(std::size_t count) { return below(count) == 0; }
  Vec3 in_cube() { return {either_sign(), either_sign(), either_sign()}; }

 private:
  std::uint64_t state_;
};

/// How often random tests repeat, as a multiple of what they do by themselves:
/// the environment's PLANETREE_TEST_EFFORT, else 1.
inline double test_effort() {
  const char* text = std::getenv("PLANETREE_TEST_EFFORT");
  const double effort = text ? std::strtod(text, nullptr) : 1;
  return effort > 0 ? effort : 1;
}

}  // namespace planetree::oracle
