#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "octree/builder/mesh/gltf/gltf_document.h"
#include "planetree/error.h"

namespace planetree::octree {

/// A mesh where a node puts it.
struct GltfPlacement {
  std::uint64_t mesh = 0;
  GltfTransform transform;
};

/// The meshes that a glTF shows.
struct GltfScene {
  std::vector<GltfPlacement> placements;  ///< in the order of the tree of nodes
  std::vector<std::string> notes;         ///< see MeshSummary::notes
};

/// Follows the tree of nodes of the document's scene: of the one that it names, else of the first.
/// Without scenes all trees are followed, and without nodes each mesh is placed once.
///
/// errors  kBadInput: a number is of no scene, node or mesh, or a node is in the tree twice.
Result<GltfScene> place_meshes(const GltfDocument& document);

}  // namespace planetree::octree
