#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "octree/builder/mesh/gltf/gltf_arrays.h"
#include "octree/builder/mesh/gltf/gltf_elements.h"
#include "octree/builder/mesh/stream/corner_attributes.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Accessors of the attributes of a primitive, those that are kept and that it has.
struct GltfAttributes {
  std::uint32_t keep = 0;  ///< of kCornerAttributes
  std::optional<GltfSequence> colors, uvs;
};

/// Reads the attributes of the vertices of a primitive. Where it has no colours they are white, and
/// where it has no texture coordinates they are zero.
class GltfAttributeReader {
 public:
  /// window_bytes  of memory for each of the arrays.
  GltfAttributeReader(const GltfAttributes& attributes, std::size_t window_bytes);

  [[nodiscard]] std::uint32_t keep() const { return keep_; }
  /// Writes the attributes of a vertex; see put_attributes().
  Result<void> read(std::uint64_t vertex, std::byte* to);

 private:
  /// Numbers of elements, integers divided by the largest if they are normalized.
  struct Source {
    Source(const GltfSequence& sequence, std::size_t window_bytes);
    /// The numbers of an element, `width` of them; false if they cannot be read.
    bool read(std::uint64_t element, double* numbers);

    ScalarType type;
    unsigned width;
    double unit;  ///< what a number is divided by, or 0
    GltfElementReader elements;
  };

  const std::uint32_t keep_;
  std::optional<Source> colors_, uvs_;
};

}  // namespace planetree::octree
