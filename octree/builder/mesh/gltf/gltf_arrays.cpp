#include "octree/builder/mesh/gltf/gltf_arrays.h"

#include <algorithm>

#include "octree/builder/mesh/gltf/gltf_error.h"
#include "octree/builder/mesh/stream/mesh_window.h"

namespace planetree::octree {

namespace {

/// The specification allows 252.
constexpr std::uint64_t kMaxStride = 4096;

std::string accessor_name(std::uint64_t accessor) { return "accessor " + std::to_string(accessor); }

bool is_unsigned(ScalarType type) {
  return type == ScalarType::kUint8 || type == ScalarType::kUint16 || type == ScalarType::kUint32;
}

}  // namespace

Result<const GltfAccessor*> GltfArrays::accessor(std::uint64_t number) const {
  if (number >= document_.accessors.size())
    return gltf_error(accessor_name(number) + " does not exist");
  return &document_.accessors[number];
}

Result<GltfArray> GltfArrays::array(const GltfElements& elements, std::uint64_t count,
                                    unsigned width, const std::string& name) {
  GltfArray made{nullptr, 0, 0, count, elements.type, width};
  made.stride = made.element_bytes();
  if (!elements.view) return made;
  if (*elements.view >= document_.views.size())
    return gltf_error(name + " names a bufferView that does not exist");
  const GltfView& view = document_.views[*elements.view];
  const auto buffer = buffers_.open(view.buffer);
  if (!buffer) return buffer.error();
  if (view.offset > buffer->range.bytes() || view.bytes > buffer->range.bytes() - view.offset)
    return gltf_error("bufferView " + std::to_string(*elements.view) + " exceeds its buffer of " +
                      std::to_string(buffer->range.bytes()) + " bytes");
  if (view.stride != 0) made.stride = view.stride;
  if (made.stride < made.element_bytes() || made.stride > kMaxStride)
    return gltf_error(name + " has elements of " + std::to_string(made.element_bytes()) +
                      " bytes every " + std::to_string(made.stride) + " bytes");
  const std::uint64_t space = view.bytes - std::min(view.bytes, elements.offset);
  const std::uint64_t most =
      space < made.element_bytes() ? 0 : (space - made.element_bytes()) / made.stride + 1;
  if (count > most)
    return gltf_error(name + " has " + std::to_string(count) + " elements, its bufferView " +
                      std::to_string(most));
  made.file = buffer->file;
  made.offset = buffer->range.begin + view.offset + elements.offset;
  return made;
}

Result<GltfSequence> GltfArrays::indices(std::uint64_t number) {
  const auto found = accessor(number);
  if (!found) return found.error();
  if ((*found)->width != 1 || !is_unsigned((*found)->elements.type))
    return gltf_error(accessor_name(number) + " has no indices: they are unsigned integers");
  return sequence(**found, accessor_name(number));
}

Result<GltfSequence> GltfArrays::positions(std::uint64_t number) {
  const auto found = accessor(number);
  if (!found) return found.error();
  if ((*found)->width != 3 || (*found)->elements.type == ScalarType::kUint32)
    return gltf_error(accessor_name(number) + " has no positions: they are a VEC3 of floats");
  return sequence(**found, accessor_name(number));
}

Result<GltfSequence> GltfArrays::colors(std::uint64_t number, std::uint64_t vertices) {
  const auto found = accessor(number);
  if (!found) return found.error();
  const GltfAccessor& declared = **found;
  const ScalarType type = declared.elements.type;
  const bool is_share = type == ScalarType::kFloat32 || declared.is_normalized;
  const bool is_known =
      type == ScalarType::kFloat32 || type == ScalarType::kUint8 || type == ScalarType::kUint16;
  if (declared.width < 3 || !is_share || !is_known)
    return gltf_error(accessor_name(number) +
                      " has no colours: they are a VEC3 or VEC4 of floats or normalized integers");
  return attribute(declared, accessor_name(number), vertices);
}

Result<GltfSequence> GltfArrays::uvs(std::uint64_t number, std::uint64_t vertices) {
  const auto found = accessor(number);
  if (!found) return found.error();
  if ((*found)->width != 2 || (*found)->elements.type == ScalarType::kUint32)
    return gltf_error(accessor_name(number) +
                      " has no texture coordinates: they are a VEC2 of floats");
  return attribute(**found, accessor_name(number), vertices);
}

Result<GltfSequence> GltfArrays::attribute(const GltfAccessor& declared, const std::string& name,
                                           std::uint64_t vertices) {
  if (declared.count != vertices)
    return gltf_error(name + " has " + std::to_string(declared.count) + " elements for " +
                      std::to_string(vertices) + " vertices");
  return sequence(declared, name);
}

Result<GltfSequence> GltfArrays::sequence(const GltfAccessor& declared, const std::string& name) {
  GltfSequence made;
  made.is_normalized = declared.is_normalized && is_integer(declared.elements.type);
  const auto base = array(declared.elements, declared.count, declared.width, name);
  if (!base) return base.error();
  made.base = *base;
  // Elements without a view take no space. So that a small file cannot declare any number of them,
  // they are few beside those that do.
  constexpr std::uint64_t kMaxZeros = 4096;
  if (base->file == nullptr && declared.count > kMaxZeros &&
      declared.count - kMaxZeros > declared.sparse_count)
    return gltf_error(name + " has " + std::to_string(declared.count) + " elements and no data");
  if (declared.sparse_count == 0) return made;
  const auto indices = array(declared.sparse_indices, declared.sparse_count, 1, name);
  if (!indices) return indices.error();
  const auto values = array(declared.sparse_values, declared.sparse_count, declared.width, name);
  if (!values) return values.error();
  if (!is_unsigned(indices->type))
    return gltf_error(name + " has sparse indices that are not unsigned integers");
  if (const auto good = check_ascending(*indices, declared.count, name); !good) return good.error();
  made.sparse_indices = *indices;
  made.sparse_values = *values;
  return made;
}

Result<void> GltfArrays::check_ascending(const GltfArray& indices, std::uint64_t end,
                                         const std::string& name) const {
  MeshWindow window(*indices.file);
  std::int64_t last = -1;
  for (std::uint64_t i = 0; i < indices.count; ++i) {
    const std::byte* const at = window.at(indices.position(i), indices.element_bytes());
    if (at == nullptr) return window.failure();
    const std::int64_t index = load_integer(indices.type, at, kSwapLittle);
    if (index <= last || static_cast<std::uint64_t>(index) >= end)
      return gltf_error(name + " has sparse indices that do not ascend, or are too large");
    last = index;
  }
  return {};
}

}  // namespace planetree::octree
