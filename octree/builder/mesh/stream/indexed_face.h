#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "octree/builder/mesh/stream/corner_attributes.h"
#include "planetree/error.h"

namespace planetree::octree {

/// What a face in memory has beside its vertices.
struct FaceAttributes {
  /// Number of a corner without a texture vertex.
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  std::optional<Color> color;                  ///< of all corners
  std::span<const TextureCoordinate> uvs;      ///< of the corners, or none
  std::span<const std::uint64_t> uv_vertices;  ///< texture vertices of the corners, or none
};

/// A face whose vertices are in memory, as FaceVertexJoin needs it.
class IndexedFace {
 public:
  /// vertices         as the file names them; must outlive this.
  /// vertices_before  the number from which negative ones count back.
  /// attributes       null if the face has none; must outlive this.
  IndexedFace(std::uint64_t record, std::span<const std::int64_t> vertices,
              std::int64_t vertices_before = 0, const FaceAttributes* attributes = nullptr)
      : record_(record),
        vertices_(vertices),
        vertices_before_(vertices_before),
        attributes_(attributes) {}

  [[nodiscard]] std::uint64_t record() const { return record_; }
  [[nodiscard]] std::uint64_t size() const { return vertices_.size(); }
  bool value_at(std::uint64_t k, std::int64_t& value) const {
    value = vertices_[static_cast<std::size_t>(k)];
    return true;
  }
  [[nodiscard]] std::int64_t vertices_before() const { return vertices_before_; }
  [[nodiscard]] std::uint64_t uv_vertex(std::uint64_t k) const {
    if (attributes_ == nullptr || attributes_->uv_vertices.empty()) return FaceAttributes::kNone;
    return attributes_->uv_vertices[static_cast<std::size_t>(k)];
  }
  bool add_attributes(std::uint64_t k, CornerAttributes& corner) const {
    if (attributes_ == nullptr) return true;
    if (attributes_->color) corner.color = *attributes_->color;
    if (!attributes_->uvs.empty()) corner.uv = attributes_->uvs[static_cast<std::size_t>(k)];
    return true;
  }
  [[nodiscard]] static Error failure() { return {}; }

 private:
  const std::uint64_t record_;
  const std::span<const std::int64_t> vertices_;
  const std::int64_t vertices_before_;
  const FaceAttributes* const attributes_;
};

}  // namespace planetree::octree
