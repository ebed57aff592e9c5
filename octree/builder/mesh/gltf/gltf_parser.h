#pragma once

#include "octree/builder/mesh/gltf/gltf_document.h"
#include "octree/builder/mesh/gltf/gltf_file.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Parses the JSON of a glTF. Memory is bounded by the numbers of nodes, meshes and accessors:
/// everything else is dropped as it is read.
///
/// errors  those of reading the file; kBadInput: no JSON, not glTF 2.0, a value of a wrong type, or
///         more than 2^20 nodes, meshes, accessors and references together; or the triangles need
///         an extension that is not read, which the text names.
Result<GltfDocument> parse_gltf(const MeshFile& file, const GltfParts& parts);

}  // namespace planetree::octree
