#include "octree/builder/mesh/gltf/gltf_vertices.h"

namespace planetree::octree {

bool fits_float32(ScalarType type, bool is_normalized, const GltfTransform& transform) {
  return !is_normalized && fits_float32(type) && transform.keeps_floats();
}

GltfVertices::GltfVertices(const GltfSequence& positions, const GltfAttributes& attributes,
                           const GltfTransform& transform, std::size_t window_bytes)
    : sequence_(positions),
      transform_(transform),
      is_identity_(transform.is_identity()),
      float32_(fits_float32(positions.base.type, positions.is_normalized, transform)),
      unit_(unit_of(positions)),
      is_plain_(!kSwapLittle && is_identity_ && positions.base.file != nullptr &&
                positions.base.type == ScalarType::kFloat32 &&
                positions.base.stride == positions.base.element_bytes() &&
                positions.sparse_indices.count == 0 && attributes.keep == 0),
      elements_(positions, window_bytes),
      attributes_(attributes, window_bytes) {}

Vec3 GltfVertices::position(const std::byte* element) const {
  const auto number = [&](std::size_t axis) {
    const ScalarType type = sequence_.base.type;
    return number_at(type, element + axis * size_bytes(type), unit_);
  };
  const Vec3 local{number(0), number(1), number(2)};
  return is_identity_ ? local : transform_.of(local);
}

Result<void> GltfVertices::read(std::uint64_t first, std::span<std::byte> out) {
  if (is_plain_) return sequence_.base.file->read(sequence_.base.position(first), out);
  const std::uint64_t count = out.size() / record_bytes();
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::byte* const element = elements_.at(first + i);
    if (element == nullptr) return elements_.failure();
    std::byte* const to = out.data() + i * record_bytes();
    put_position(position(element), float32_, to);
    if (attributes() == 0) continue;
    if (const auto read = attributes_.read(first + i, to + position_bytes()); !read) return read;
  }
  return {};
}

}  // namespace planetree::octree
