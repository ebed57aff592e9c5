#include "octree/builder/mesh/gltf/gltf_faces.h"

#include <utility>

namespace planetree::octree {

namespace {

std::uint64_t triangles_of(std::uint64_t corners, GltfMode mode) {
  if (mode == GltfMode::kTriangles) return corners / 3;
  return corners < 3 ? 0 : corners - 2;
}

}  // namespace

GltfFaces::GltfFaces(const std::optional<GltfSequence>& indices, std::uint64_t vertex_count,
                     GltfMode mode, bool is_turned, std::size_t window_bytes)
    : mode_(mode),
      is_turned_(is_turned),
      type_(indices ? indices->base.type : ScalarType::kUint32),
      index_bytes_(size_bytes(type_)),
      corner_count_(indices ? indices->base.count : vertex_count),
      triangle_count_(triangles_of(corner_count_, mode)) {
  if (indices) indices_.emplace(*indices, window_bytes);
}

bool GltfFaces::read_index(std::uint64_t k, std::int64_t& index) {
  if (!indices_) {
    index = static_cast<std::int64_t>(k);
    return true;
  }
  const std::byte* const element = indices_->at(k);
  if (element == nullptr) {
    failure_ = indices_->failure();
    return false;
  }
  index = load_integer(type_, element, kSwapLittle);
  return true;
}

// The order of corners is that of the specification, section 3.7.2.1.
std::array<std::uint64_t, 3> GltfFaces::corners_of(std::uint64_t triangle) const {
  std::array<std::uint64_t, 3> corners = {triangle, triangle + 1, triangle + 2};
  if (mode_ == GltfMode::kTriangles) corners = {3 * triangle, 3 * triangle + 1, 3 * triangle + 2};
  if (mode_ == GltfMode::kFan) corners = {triangle + 1, triangle + 2, 0};
  const bool is_second = mode_ == GltfMode::kStrip && triangle % 2 == 1;
  if (is_second != is_turned_) std::swap(corners[1], corners[2]);
  return corners;
}

bool GltfFaces::read(std::uint64_t triangle, std::array<std::int64_t, 3>& vertices) {
  const std::array<std::uint64_t, 3> corners = corners_of(triangle);
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_hub = mode_ == GltfMode::kFan && corners[i] == 0;
    if (is_hub && hub_) {
      vertices[i] = *hub_;
    } else if (!read_index(corners[i], vertices[i])) {
      return false;
    }
    if (is_hub) hub_ = vertices[i];
  }
  return true;
}

}  // namespace planetree::octree
