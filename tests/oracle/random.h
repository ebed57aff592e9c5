#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "planetree/types.h"

namespace planetree::oracle {

/// Random numbers that are the same everywhere (SplitMix64), provided that no expression draws two:
/// compilers differ in the order of evaluation. Braced initialisers are evaluated in order.
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
  /// A number between 2^low and 2^high, of any order of magnitude. Computed by arithmetic alone: a
  /// power of two for whole exponents, linear between them.
  double magnitude(double low, double high) {
    const double exponent = between(low, high), whole = std::floor(exponent);
    return std::ldexp(1 + (exponent - whole), static_cast<int>(whole));
  }
  double signed_magnitude(double low, double high) {
    const double sign = either_sign();
    return sign * magnitude(low, high);
  }
  bool one_in(std::size_t count) { return below(count) == 0; }
  Vec3 in_cube() {
    const double x = either_sign(), y = either_sign(), z = either_sign();
    return {x, y, z};
  }
  /// A point in a cube of any order of magnitude.
  Vec3 in_some_cube(double low, double high) {
    const Vec3 at = in_cube();
    const double size = magnitude(low, high);
    return {at.x * size, at.y * size, at.z * size};
  }

 private:
  std::uint64_t state_;
};

/// Factor for the number of repetitions of random tests: the environment's PLANETREE_TEST_EFFORT,
/// or 1.
inline double test_effort() {
  const char* text = std::getenv("PLANETREE_TEST_EFFORT");
  const double effort = text ? std::strtod(text, nullptr) : 1;
  return effort > 0 ? effort : 1;
}

}  // namespace planetree::oracle
