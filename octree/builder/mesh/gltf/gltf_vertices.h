#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/builder/mesh/gltf/gltf_arrays.h"
#include "octree/builder/mesh/gltf/gltf_attributes.h"
#include "octree/builder/mesh/gltf/gltf_elements.h"
#include "octree/builder/mesh/gltf/gltf_transform.h"
#include "octree/builder/mesh/stream/mesh_vertices.h"

namespace planetree::octree {

/// The vertices of a primitive where a node puts them.
class GltfVertices final : public MeshVertices {
 public:
  /// window_bytes  of memory for reading.
  GltfVertices(const GltfSequence& positions, const GltfAttributes& attributes,
               const GltfTransform& transform, std::size_t window_bytes);

  [[nodiscard]] std::uint64_t count() const override { return sequence_.base.count; }
  [[nodiscard]] bool float32() const override { return float32_; }
  [[nodiscard]] std::uint32_t attributes() const override { return attributes_.keep(); }
  Result<void> read(std::uint64_t first, std::span<std::byte> out) override;

 private:
  [[nodiscard]] Vec3 position(const std::byte* element) const;

  const GltfSequence sequence_;
  const GltfTransform transform_;
  const bool is_identity_;
  const bool float32_;
  const double unit_;    ///< what an integer is divided by
  const bool is_plain_;  ///< elements in the file have the form that MeshVertices has
  GltfElementReader elements_;
  GltfAttributeReader attributes_;
};

/// Whether float32 holds all positions of such elements where a node puts them.
bool fits_float32(ScalarType type, bool is_normalized, const GltfTransform& transform);

}  // namespace planetree::octree
