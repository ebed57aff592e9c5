#pragma once

#include <cstdint>

#include "tools/shapes/shape_lattice.h"
#include "tools/shapes/shape_model.h"
#include "tools/shapes/shape_noise.h"

/// Shapes with a boundary, which enclose nothing.
namespace planetree::tools {

/// A height field over the square [-100, 100]^2, with heights of about -30 to 30: 2 n^2 triangles
/// that face up.
class Terrain final : public Shape {
 public:
  Terrain(std::uint64_t n, std::uint64_t seed);

  std::uint64_t vertex_count() const override { return lattice_.point_count(); }
  std::uint64_t triangle_count() const override { return lattice_.triangle_count(); }
  Vec3 vertex(std::uint64_t index) const override;
  Corners triangle(std::uint64_t index) const override;

 private:
  GridLattice lattice_;
  FractalNoise noise_;
};

/// Random triangles in [0, 1]^3 that share no vertex. Each lies in a small cube; all small cubes
/// side by side would about fill the unit cube.
class Soup final : public Shape {
 public:
  /// triangles  1 to 2^40
  Soup(std::uint64_t triangles, std::uint64_t seed);

  std::uint64_t vertex_count() const override { return 3 * triangles_; }
  std::uint64_t triangle_count() const override { return triangles_; }
  Vec3 vertex(std::uint64_t index) const override;
  Corners triangle(std::uint64_t index) const override;

 private:
  std::uint64_t triangles_;
  std::uint64_t centre_stream_;
  std::uint64_t corner_stream_;
  double size_;
};

}  // namespace planetree::tools
