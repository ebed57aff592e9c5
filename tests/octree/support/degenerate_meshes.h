#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "planetree/types.h"

/// Meshes of any size that make careless builds slow: fans, needles, copies, segments and points.
namespace planetree::octree {

/// A mesh of size about 1 whose coordinates are floats.
struct IndexedMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  std::vector<std::array<Vec3, 3>> soup() const;
};

/// A closed cylinder of some rings. Both ends are fans about one vertex.
IndexedMesh fan_cylinder_mesh(std::uint32_t sides, std::uint32_t rings);

/// A kind of mesh that has about as many triangles as are asked for.
struct DegenerateKind {
  std::string_view name;
  std::string_view about;
  IndexedMesh (*make)(std::uint32_t triangles);
};

std::span<const DegenerateKind> degenerate_kinds();
/// Null if there is none of that name.
const DegenerateKind* degenerate_kind(std::string_view name);

}  // namespace planetree::octree
