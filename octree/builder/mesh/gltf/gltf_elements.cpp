#include "octree/builder/mesh/gltf/gltf_elements.h"

namespace planetree::octree {

namespace {

/// The largest integer of a type.
double largest(ScalarType type) {
  switch (type) {
    case ScalarType::kInt8:
      return 127;
    case ScalarType::kUint8:
      return 255;
    case ScalarType::kInt16:
      return 32767;
    default:
      return 65535;
  }
}

constexpr std::uint64_t kNone = ~std::uint64_t{0};
constexpr std::array<std::byte, 3 * sizeof(double)> kZeros = {};

}  // namespace

double unit_of(const GltfSequence& sequence) {
  return sequence.is_normalized ? largest(sequence.base.type) : 0;
}

GltfElementReader::Source::Source(const GltfArray& elements, std::size_t window_bytes)
    : array(elements) {
  if (array.file != nullptr) window = std::make_unique<MeshWindow>(*array.file, window_bytes);
}

const std::byte* GltfElementReader::Source::at(std::uint64_t element) {
  return window ? window->at(array.position(element), array.element_bytes()) : kZeros.data();
}

GltfElementReader::GltfElementReader(const GltfSequence& sequence, std::size_t window_bytes)
    : base_(sequence.base, window_bytes),
      indices_(sequence.sparse_indices, window_bytes),
      values_(sequence.sparse_values, window_bytes) {}

const std::byte* GltfElementReader::read(Source& source, std::uint64_t element) {
  const std::byte* const found = source.at(element);
  if (found == nullptr) failure_ = source.window->failure();
  return found;
}

bool GltfElementReader::read_index(std::uint64_t sparse, std::uint64_t& index) {
  index = kNone;
  if (sparse >= indices_.array.count) return true;
  const std::byte* const found = read(indices_, sparse);
  if (found == nullptr) return false;
  index = static_cast<std::uint64_t>(load_integer(indices_.array.type, found, kSwapLittle));
  return true;
}

bool GltfElementReader::seek(std::uint64_t element) {
  std::uint64_t first = 0, last = indices_.array.count;
  while (first < last) {
    const std::uint64_t middle = first + (last - first) / 2;
    std::uint64_t index = 0;
    if (!read_index(middle, index)) return false;
    if (index < element) {
      first = middle + 1;
    } else {
      last = middle;
    }
  }
  next_sparse_ = first;
  return read_index(first, sparse_index_);
}

const std::byte* GltfElementReader::at(std::uint64_t element) {
  if (indices_.array.count == 0) return read(base_, element);
  const bool goes_on = is_ready_ && element >= next_element_ && element <= sparse_index_;
  if (!goes_on && !seek(element)) return nullptr;
  is_ready_ = true;
  next_element_ = element;
  return element == sparse_index_ ? read(values_, next_sparse_) : read(base_, element);
}

}  // namespace planetree::octree
