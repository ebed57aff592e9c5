#pragma once

#include <array>
#include <cstdint>

#include "planetree/types.h"

namespace planetree::tools {

/// Mixes all bits of `value`, as a bijection. The outputs for 0, 1, 2, ... serve as independent
/// random numbers.
///
/// source  Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014:
///         the finaliser of SplitMix64
std::uint64_t mixed_bits(std::uint64_t value);

/// The `counter`-th random number of a stream, uniform in [0, 1).
double random_unit(std::uint64_t stream, std::uint64_t counter);

/// Gradient noise summed over octaves. Each octave has twice the frequency and half the amplitude
/// of the one before.
///
/// threads  any number at once
/// source   Perlin, "Improving noise", SIGGRAPH 2002, with an integer hash instead of the
///          permutation table
class FractalNoise {
 public:
  static constexpr int kOctaves = 11;
  /// Maximum magnitude of a value. Along each axis the mean distance to the two ends of a cell,
  /// weighted by the blend, is at most 1/2. Three axes therefore give at most 3/2 an octave, and
  /// the amplitudes sum to less than 2.
  static constexpr double kBound = 3;

  /// base_frequency  lattice cells of the first octave per unit of length; above 0, at most 1000
  FractalNoise(std::uint64_t seed, double base_frequency);

  /// The noise at a position with coordinates in [-1, 1]. Values are rarely outside of [-1, 1] and
  /// never outside of [-kBound, kBound].
  double at(const Vec3& position) const;

 private:
  struct Octave {
    double frequency;
    double amplitude;
    Vec3 offset;  ///< makes lattice coordinates positive and octaves independent
    std::uint32_t seed;
  };
  std::array<Octave, kOctaves> octaves_;
};

}  // namespace planetree::tools
