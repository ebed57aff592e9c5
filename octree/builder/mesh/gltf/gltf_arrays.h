#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "octree/builder/mesh/gltf/gltf_buffers.h"
#include "octree/builder/mesh/gltf/gltf_document.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/scalar_type.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Elements in a file, one every `stride` bytes. The file has all of them.
struct GltfArray {
  const MeshFile* file = nullptr;  ///< null: all elements are zero
  std::uint64_t offset = 0, stride = 0, count = 0;
  ScalarType type = ScalarType::kFloat32;
  unsigned width = 1;  ///< numbers of an element

  [[nodiscard]] std::uint64_t element_bytes() const { return width * size_bytes(type); }
  [[nodiscard]] std::uint64_t position(std::uint64_t element) const {
    return offset + element * stride;
  }
};

/// The elements of an accessor.
struct GltfSequence {
  GltfArray base;
  bool is_normalized = false;  ///< integers stand for fractions of the largest
  /// Elements in place of those in `base`, if any. The indices ascend.
  GltfArray sparse_indices, sparse_values;
};

/// Finds the elements of accessors, and checks that they are within their views and buffers.
class GltfArrays {
 public:
  /// Both must outlive this.
  GltfArrays(const GltfDocument& document, GltfBuffers& buffers)
      : document_(document), buffers_(buffers) {}

  /// errors  kBadInput: there is no such accessor, it is not made of such elements, or exceeds its
  ///         view or buffer. Those of GltfBuffers::open().
  Result<GltfSequence> positions(std::uint64_t accessor);
  Result<GltfSequence> indices(std::uint64_t accessor);
  /// For as many vertices as positions.
  Result<GltfSequence> colors(std::uint64_t accessor, std::uint64_t vertices);
  Result<GltfSequence> uvs(std::uint64_t accessor, std::uint64_t vertices);

 private:
  Result<const GltfAccessor*> accessor(std::uint64_t number) const;
  /// Checks the number of elements of an attribute.
  Result<GltfSequence> attribute(const GltfAccessor& accessor, const std::string& name,
                                 std::uint64_t vertices);
  Result<GltfSequence> sequence(const GltfAccessor& accessor, const std::string& name);
  Result<GltfArray> array(const GltfElements& elements, std::uint64_t count, unsigned width,
                          const std::string& name);
  Result<void> check_ascending(const GltfArray& indices, std::uint64_t end,
                               const std::string& name) const;

  const GltfDocument& document_;
  GltfBuffers& buffers_;
};

}  // namespace planetree::octree
