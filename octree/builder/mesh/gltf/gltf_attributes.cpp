#include "octree/builder/mesh/gltf/gltf_attributes.h"

#include <array>

namespace planetree::octree {

namespace {

constexpr Color kWhite = {255, 255, 255, 255};

}  // namespace

GltfAttributeReader::Source::Source(const GltfSequence& sequence, std::size_t window_bytes)
    : type(sequence.base.type),
      width(sequence.base.width),
      unit(unit_of(sequence)),
      elements(sequence, window_bytes) {}

bool GltfAttributeReader::Source::read(std::uint64_t element, double* numbers) {
  const std::byte* const at = elements.at(element);
  if (at == nullptr) return false;
  for (unsigned i = 0; i < width; ++i)
    numbers[i] = number_at(type, at + i * size_bytes(type), unit);
  return true;
}

GltfAttributeReader::GltfAttributeReader(const GltfAttributes& attributes, std::size_t window_bytes)
    : keep_(attributes.keep) {
  if (attributes.colors) colors_.emplace(*attributes.colors, window_bytes);
  if (attributes.uvs) uvs_.emplace(*attributes.uvs, window_bytes);
}

Result<void> GltfAttributeReader::read(std::uint64_t vertex, std::byte* to) {
  CornerAttributes attributes{kWhite, {}};
  std::array<double, 4> numbers = {0, 0, 0, 1};
  if (colors_) {
    if (!colors_->read(vertex, numbers.data())) return colors_->elements.failure();
    const auto channel = [&numbers](std::size_t i) { return to_channel(numbers[i] * 255); };
    attributes.color = {channel(0), channel(1), channel(2), channel(3)};
  }
  if (uvs_) {
    if (!uvs_->read(vertex, numbers.data())) return uvs_->elements.failure();
    attributes.uv = {static_cast<float>(numbers[0]), static_cast<float>(numbers[1])};
  }
  put_attributes(attributes, keep_, to);
  return {};
}

}  // namespace planetree::octree
