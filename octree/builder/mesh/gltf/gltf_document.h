#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "octree/builder/mesh/gltf/gltf_file.h"
#include "octree/builder/mesh/gltf/gltf_transform.h"
#include "octree/builder/mesh/stream/scalar_type.h"

/// What a glTF says of its triangles. Numbers of other records are as in the file: those behind the
/// end of a list are possible.
///
/// source  glTF 2.0 specification (Khronos, 2021), sections 3.5 to 3.7 and 5
namespace planetree::octree {

struct GltfBuffer {
  std::uint64_t bytes = 0;
  std::optional<std::string> uri;         ///< of a file beside the glTF
  std::optional<std::uint64_t> embedded;  ///< number in GltfDocument::embedded
  bool is_fallback = false;               ///< has no content, only what compressed views stand for
};

struct GltfView {
  std::uint64_t buffer = 0, offset = 0, bytes = 0;
  std::uint64_t stride = 0;  ///< 0: elements are side by side
  bool is_meshopt = false;   ///< also there in a form compressed by meshoptimizer
};

/// Elements of a view.
struct GltfElements {
  std::optional<std::uint64_t> view;  ///< none: all elements are zero
  std::uint64_t offset = 0;           ///< in the view
  ScalarType type = ScalarType::kFloat32;
};

struct GltfAccessor {
  GltfElements elements;
  std::uint64_t count = 0;
  unsigned width = 0;  ///< numbers of an element: 1 of a scalar, 2 to 4 of a vector; 0 of others
  bool is_normalized = false;
  std::uint64_t sparse_count = 0;
  GltfElements sparse_indices, sparse_values;
};

struct GltfPrimitive {
  unsigned mode = 4;
  std::optional<std::uint64_t> positions, indices, colors, uvs;  ///< accessors
  bool is_draco = false;
  bool has_targets = false;
};

/// Elements [first, first + count) of a list of the document.
struct GltfSlice {
  std::uint64_t first = 0, count = 0;
};

struct GltfNode {
  GltfTransform local;
  std::optional<std::uint64_t> mesh;
  GltfSlice children;  ///< of GltfDocument::links
  bool has_skin = false;
  bool has_instances = false;  ///< by EXT_mesh_gpu_instancing
};

struct GltfDocument {
  std::vector<GltfBuffer> buffers;
  std::vector<GltfView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfPrimitive> primitives;
  std::vector<GltfSlice> meshes;  ///< of primitives
  std::vector<GltfNode> nodes;
  std::vector<GltfSlice> scenes;     ///< of links
  std::vector<std::uint64_t> links;  ///< nodes
  std::optional<std::uint64_t> scene;
  std::vector<FileRange> embedded;  ///< data of strings, in base64
};

}  // namespace planetree::octree
