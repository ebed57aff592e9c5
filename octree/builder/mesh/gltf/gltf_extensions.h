#pragma once

#include "octree/builder/mesh/gltf/gltf_object.h"

namespace planetree::octree {

inline constexpr const char* kDraco = "KHR_draco_mesh_compression";
inline constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

/// Whether a buffer or a view is compressed by meshoptimizer, as either of two extensions has it.
bool has_meshopt(const GltfObject& object);

/// Throws a GltfFault if the document requires an extension without which its triangles are not
/// what they are meant to be. Extensions of materials, lights, textures and the like are not.
///
/// root  the document.
void check_extensions(const GltfObject& root);

}  // namespace planetree::octree
