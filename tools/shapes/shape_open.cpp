#include "tools/shapes/shape_open.h"

namespace planetree::tools {
namespace {

constexpr double kTerrainHalfSide = 100;
constexpr double kTerrainHeight = 25;
constexpr double kTerrainFrequency = 1.5;

/// The greatest integer with a cube of at most `value`, which must be below 2^60.
std::uint64_t integer_cube_root(std::uint64_t value) {
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 19; bit != 0; bit >>= 1) {
    const std::uint64_t trial = root + bit;
    if (trial * trial * trial <= value) root = trial;
  }
  return root;
}

Vec3 random_position(std::uint64_t stream, std::uint64_t counter) {
  return {random_unit(stream, 3 * counter), random_unit(stream, 3 * counter + 1),
          random_unit(stream, 3 * counter + 2)};
}

}  // namespace

Terrain::Terrain(std::uint64_t n, std::uint64_t seed)
    : lattice_(n), noise_(seed, kTerrainFrequency) {}

Vec3 Terrain::vertex(std::uint64_t index) const {
  const LatticePoint point = lattice_.point(index);
  const double x = centred_coordinate(point.i, lattice_.n());
  const double y = centred_coordinate(point.j, lattice_.n());
  return {kTerrainHalfSide * x, kTerrainHalfSide * y, kTerrainHeight * noise_.at({x, y, 0})};
}

Corners Terrain::triangle(std::uint64_t index) const {
  const auto [a, b, c] = lattice_.triangle(index);
  return {lattice_.index(a.i, a.j), lattice_.index(b.i, b.j), lattice_.index(c.i, c.j)};
}

Soup::Soup(std::uint64_t triangles, std::uint64_t seed)
    : triangles_(triangles),
      centre_stream_(mixed_bits(seed)),
      corner_stream_(mixed_bits(centre_stream_)),
      size_(1 / static_cast<double>(integer_cube_root(triangles) + 1)) {}

Vec3 Soup::vertex(std::uint64_t index) const {
  const Vec3 position = random_position(centre_stream_, index / 3);
  const Vec3 corner = random_position(corner_stream_, index);
  const double extent = 1 - size_;
  return {extent * position.x + size_ * corner.x, extent * position.y + size_ * corner.y,
          extent * position.z + size_ * corner.z};
}

Corners Soup::triangle(std::uint64_t index) const {
  return {3 * index, 3 * index + 1, 3 * index + 2};
}

}  // namespace planetree::tools
