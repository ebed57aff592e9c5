#pragma once

#include <cstdint>

#include "tools/shapes/shape_lattice.h"
#include "tools/shapes/shape_model.h"
#include "tools/shapes/shape_noise.h"

/// Watertight shapes: closed lattices whose points are moved without folding the surface.
namespace planetree::tools {

inline constexpr double kShapeRadius = 100;
inline constexpr double kShapeHeight = 200;

/// A shape whose triangles are connected like those of a cube's surface: 12 n^2 triangles.
class CubeShape : public Shape {
 public:
  explicit CubeShape(std::uint64_t n) : lattice_(n) {}

  std::uint64_t vertex_count() const final { return lattice_.point_count(); }
  std::uint64_t triangle_count() const final { return lattice_.triangle_count(); }
  Corners triangle(std::uint64_t index) const final { return lattice_.triangle(index); }

 protected:
  /// The lattice point scaled to the cube [-1, 1]^3.
  Vec3 cube_position(std::uint64_t index) const;

 private:
  CubeLattice lattice_;
};

/// A sphere of radius kShapeRadius about the origin.
class Sphere final : public CubeShape {
 public:
  using CubeShape::CubeShape;
  Vec3 vertex(std::uint64_t index) const override;
};

/// The sphere with every point moved along its ray from the origin, by about a quarter of the
/// radius at most and always by less than the radius. It is star-shaped about the origin, and
/// therefore does not intersect itself.
class Statue final : public CubeShape {
 public:
  Statue(std::uint64_t n, std::uint64_t seed);
  Vec3 vertex(std::uint64_t index) const override;

 private:
  FractalNoise noise_;
};

/// A cylinder about the z axis, centred on the origin, of radius kShapeRadius and height
/// kShapeHeight.
class Cylinder final : public CubeShape {
 public:
  using CubeShape::CubeShape;
  Vec3 vertex(std::uint64_t index) const override;
};

/// A cone with a base of radius kShapeRadius in the plane z = 0 and the apex at z = kShapeHeight:
/// 4 n^2 triangles, n even.
class Cone final : public Shape {
 public:
  explicit Cone(std::uint64_t n) : lattice_(n) {}

  std::uint64_t vertex_count() const override { return lattice_.point_count(); }
  std::uint64_t triangle_count() const override { return lattice_.triangle_count(); }
  Vec3 vertex(std::uint64_t index) const override;
  Corners triangle(std::uint64_t index) const override { return lattice_.triangle(index); }

 private:
  PillowLattice lattice_;
};

}  // namespace planetree::tools
