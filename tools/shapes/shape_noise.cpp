#include "tools/shapes/shape_noise.h"

#include <cassert>
#include <cstddef>

namespace planetree::tools {
namespace {

struct Gradient {
  double x, y, z;
};

/// The midpoints of a cube's 12 edges. Four appear twice, to make a power of two.
constexpr Gradient kGradients[16] = {
    {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
    {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {0, -1, 1}, {-1, 1, 0}, {0, -1, -1}};

const Gradient& corner_gradient(std::uint32_t hash) {
  hash ^= hash >> 15;
  hash *= 0x2c1b3c6dU;
  return kGradients[hash >> 28];
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

double blend(double from, double to, double part) { return from + part * (to - from); }

/// One coordinate of a position: the hashes of its lattice cell and the position within the cell.
struct Coordinate {
  std::uint32_t low_hash, high_hash;
  double low, high;  ///< distance from the cell's lower end and, negative, from its upper end
  double part;

  /// `position` is positive and below 2^31.
  Coordinate(double position, std::uint32_t multiplier) {
    const auto cell = static_cast<std::int32_t>(position);
    low_hash = static_cast<std::uint32_t>(cell) * multiplier;
    high_hash = low_hash + multiplier;
    low = position - cell;
    high = low - 1;
    part = fade(low);
  }
};

/// The noise on an edge of a cell along x; y and z are the distances from that edge.
double edge_noise(const Coordinate& x, double y, double z, std::uint32_t hash) {
  const Gradient& from = corner_gradient(x.low_hash ^ hash);
  const Gradient& to = corner_gradient(x.high_hash ^ hash);
  return blend(from.x * x.low + from.y * y + from.z * z, to.x * x.high + to.y * y + to.z * z,
               x.part);
}

double gradient_noise(double position_x, double position_y, double position_z, std::uint32_t seed) {
  const Coordinate x(position_x, 0x1b873593U);
  const Coordinate y(position_y, 0x85ebca6bU);
  const Coordinate z(position_z, 0xcc9e2d51U);
  const std::uint32_t front = z.low_hash ^ seed;
  const std::uint32_t back = z.high_hash ^ seed;
  return blend(blend(edge_noise(x, y.low, z.low, y.low_hash ^ front),
                     edge_noise(x, y.high, z.low, y.high_hash ^ front), y.part),
               blend(edge_noise(x, y.low, z.high, y.low_hash ^ back),
                     edge_noise(x, y.high, z.high, y.high_hash ^ back), y.part),
               z.part);
}

}  // namespace

std::uint64_t mixed_bits(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15U;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31);
}

double random_unit(std::uint64_t stream, std::uint64_t counter) {
  const std::uint64_t bits = mixed_bits(mixed_bits(stream) + counter * 0x9e3779b97f4a7c15U);
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

FractalNoise::FractalNoise(std::uint64_t seed, double base_frequency) {
  assert(base_frequency > 0 && base_frequency <= 1000);
  double frequency = base_frequency;
  double amplitude = 1;
  std::uint64_t counter = 0;
  for (Octave& octave : octaves_) {
    const auto offset = [&] { return frequency + 1 + random_unit(seed, counter++); };
    octave.frequency = frequency;
    octave.amplitude = amplitude;
    octave.offset.x = offset();
    octave.offset.y = offset();
    octave.offset.z = offset();
    octave.seed = static_cast<std::uint32_t>(mixed_bits(mixed_bits(seed) ^ counter));
    frequency *= 2;
    amplitude *= 0.5;
  }
}

double FractalNoise::at(const Vec3& position) const {
  double sum = 0;
  for (const Octave& octave : octaves_) {
    sum += octave.amplitude * gradient_noise(position.x * octave.frequency + octave.offset.x,
                                             position.y * octave.frequency + octave.offset.y,
                                             position.z * octave.frequency + octave.offset.z,
                                             octave.seed);
  }
  return sum;
}

}  // namespace planetree::tools
