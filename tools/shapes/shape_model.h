#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "planetree/error.h"
#include "planetree/types.h"

namespace planetree::tools {

/// Kinds of models that can be generated. Lengths can be taken as millimetres.
enum class ShapeKind : std::uint8_t {
  kStatue,    ///< the sphere, displaced radially by 11 octaves of noise: closed
  kSphere,    ///< radius 100: closed
  kCylinder,  ///< radius 100, height 200 along z: closed
  kCone,      ///< base of radius 100 at z = 0, apex at z = 200: closed
  kTerrain,   ///< a height field over a square of side 200: open
  kSoup,      ///< small random triangles in a unit cube that share no vertex
};

inline constexpr std::array<ShapeKind, 6> kAllShapeKinds = {
    ShapeKind::kStatue, ShapeKind::kSphere,  ShapeKind::kCylinder,
    ShapeKind::kCone,   ShapeKind::kTerrain, ShapeKind::kSoup};

/// The kind's name on the command line: "statue", "sphere", ...
std::string_view shape_name(ShapeKind kind);
/// The kind of that name, if any.
std::optional<ShapeKind> shape_named(std::string_view name);

/// A triangle mesh of any size that takes no memory. Each vertex and triangle is computed from its
/// index alone, by IEEE double operations that give the same bits with every compiler and machine.
///
/// threads  any number at once
class Shape {
 public:
  /// Number of values of a 32-bit index.
  static constexpr std::uint64_t kMaxVertices = std::uint64_t{1} << 32;

  virtual ~Shape() = default;

  virtual std::uint64_t vertex_count() const = 0;
  virtual std::uint64_t triangle_count() const = 0;
  /// Position of one vertex; index < vertex_count().
  virtual Vec3 vertex(std::uint64_t index) const = 0;
  /// The three vertices of one triangle, counter-clockwise seen from outside, for the terrain from
  /// above; index < triangle_count().
  virtual std::array<std::uint64_t, 3> triangle(std::uint64_t index) const = 0;
};

/// Makes a shape of about `triangles` triangles: the nearest count that its lattice allows, and
/// exactly `triangles` for the soup. A sphere, statue or cylinder has at least 12, a cone 16 and a
/// terrain 2.
///
/// seed    chooses the noise of statue and terrain and the positions of the soup
/// errors  kBadArgument: no triangle, or more than kMaxVertices vertices
Result<std::unique_ptr<Shape>> make_shape(ShapeKind kind, std::uint64_t triangles,
                                          std::uint64_t seed);

}  // namespace planetree::tools
