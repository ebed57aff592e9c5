#pragma once

#include <span>

#include "tests/oracle/nasty_models.h"

/// Watertight models, well formed or not.
namespace planetree::oracle {

/// The faces of a box, oriented outward.
Soup box(const Vec3& lower, const Vec3& upper);
/// The faces of a tetrahedron, oriented outward if d is behind the triangle a b c.
Soup tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// A sphere of radius 1 with 8 * 4^levels faces, oriented outward.
Soup ball(unsigned levels);
/// Reverses the orientation of every face.
Soup inside_out(Soup triangles);
Soup operator+(Soup left, const Soup& right);

/// Families of watertight models with up to 500 triangles of size about 1: degenerate, overlapping,
/// inside out.
std::span<const NastyFamily> closed_families();

}  // namespace planetree::oracle
