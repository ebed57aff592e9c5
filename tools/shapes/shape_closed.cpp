#include "tools/shapes/shape_closed.h"

#include <algorithm>
#include <cmath>

namespace planetree::tools {
namespace {

/// Gives lobes about as large as the radius, so that the statue looks like a weathered rock.
constexpr double kStatueFrequency = 1.6;
constexpr double kStatueAmplitude = 0.25;
static_assert(kStatueAmplitude * FractalNoise::kBound < 1, "no ray may turn around");

/// Maps a point of the surface of [-1, 1]^3 to the unit sphere. Triangles have much more even sizes
/// than with a division by the length.
///
/// source  Philip Nowell, "Mapping a cube to a sphere", 2005
Vec3 cube_to_sphere(const Vec3& p) {
  const double xx = p.x * p.x, yy = p.y * p.y, zz = p.z * p.z;
  return {p.x * std::sqrt(1 - yy / 2 - zz / 2 + yy * zz / 3),
          p.y * std::sqrt(1 - zz / 2 - xx / 2 + zz * xx / 3),
          p.z * std::sqrt(1 - xx / 2 - yy / 2 + xx * yy / 3)};
}

double square_radius(double x, double y) { return std::max(std::abs(x), std::abs(y)); }

/// Maps a point of [-1, 1]^2 to the unit disc along its ray from the origin: squares become
/// circles. Unlike smooth maps this does not flatten the corners, so that corner triangles keep an
/// area even with billions of triangles. z is 0.
Vec3 square_to_disc(double x, double y) {
  const double length = std::sqrt(x * x + y * y);
  if (length == 0) return {};
  const double scale = square_radius(x, y) / length;
  return {x * scale, y * scale, 0};
}

}  // namespace

Vec3 CubeShape::cube_position(std::uint64_t index) const {
  const LatticePoint point = lattice_.point(index);
  const std::uint64_t n = lattice_.n();
  return {centred_coordinate(point.i, n), centred_coordinate(point.j, n),
          centred_coordinate(point.k, n)};
}

Vec3 Sphere::vertex(std::uint64_t index) const {
  const Vec3 direction = cube_to_sphere(cube_position(index));
  return {kShapeRadius * direction.x, kShapeRadius * direction.y, kShapeRadius * direction.z};
}

Statue::Statue(std::uint64_t n, std::uint64_t seed)
    : CubeShape(n), noise_(seed, kStatueFrequency) {}

Vec3 Statue::vertex(std::uint64_t index) const {
  const Vec3 direction = cube_to_sphere(cube_position(index));
  const double radius = kShapeRadius * (1 + kStatueAmplitude * noise_.at(direction));
  return {radius * direction.x, radius * direction.y, radius * direction.z};
}

Vec3 Cylinder::vertex(std::uint64_t index) const {
  const Vec3 position = cube_position(index);
  const Vec3 disc = square_to_disc(position.x, position.y);
  return {kShapeRadius * disc.x, kShapeRadius * disc.y, kShapeHeight / 2 * position.z};
}

Vec3 Cone::vertex(std::uint64_t index) const {
  const LatticePoint point = lattice_.point(index);
  const double x = centred_coordinate(point.i, lattice_.n());
  const double y = centred_coordinate(point.j, lattice_.n());
  const Vec3 disc = square_to_disc(x, y);
  const double height = point.k == 0 ? 0 : kShapeHeight * (1 - square_radius(x, y));
  return {kShapeRadius * disc.x, kShapeRadius * disc.y, height};
}

}  // namespace planetree::tools
