#pragma once

#include <array>
#include <cstdint>

#include "octree/build/mesh_store.h"
#include "octree/triangle_distance.h"
#include "storage/file_layout.h"

namespace planetree::octree {

/// An edge that more faces run along one way than the other.
struct OpenEdge {
  std::uint64_t triangle = kNoTriangle;  ///< the first that has it
  Point from = Point::Zero();            ///< its ends as that triangle runs along it,
  Point to = Point::Zero();              ///< model frame
  std::uint32_t along = 0;               ///< faces that run from `from` to `to`
  std::uint32_t against = 0;             ///< faces that run the other way
};

/// Whether a surface closes: it does if as many faces run along every edge one
/// way as the other, edges being the same where their ends are. Then, and only
/// then, winding numbers are whole and constant off the surface; so soups of
/// closed surfaces, doubled ones and edges of four faces count as closed.
struct EdgeBalance {
  static constexpr std::size_t kListed = 3;

  std::uint64_t open_edges = 0;
  /// The first open edges by triangle, then corner.
  std::array<OpenEdge, kListed> first;

  /// Writes what is known into the model's record, in the input's units.
  void describe(int scale_exponent, storage::ModelRecord& model) const;
};

/// Balances the edges of a normalised mesh.
///
/// memory  24 bytes a triangle.
/// threads those of the caller's task arena; the result does not depend on them.
EdgeBalance balance_edges(const MeshStore& mesh);

}  // namespace planetree::octree
