#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "octree/builder/mesh/gltf/gltf_arrays.h"
#include "octree/builder/mesh/gltf/gltf_elements.h"
#include "octree/builder/mesh/stream/face_vertex_join.h"
#include "octree/builder/mesh/stream/indexed_face.h"
#include "planetree/error.h"

namespace planetree::octree {

/// How indices make triangles: the modes of glTF that do.
enum class GltfMode : std::uint8_t { kTriangles = 4, kStrip = 5, kFan = 6 };

/// The triangles of a primitive. One of a strip or a fan that names a vertex twice is left out and
/// takes no number: it only leads on to the next one.
class GltfFaces {
 public:
  /// indices       none: the vertices in their order.
  /// vertex_count  of the primitive.
  /// is_turned     whether corners are exchanged, so that a mirrored triangle faces outwards.
  GltfFaces(const std::optional<GltfSequence>& indices, std::uint64_t vertex_count, GltfMode mode,
            bool is_turned, std::size_t window_bytes);

  /// Bytes of the indices; the unit of progress.
  [[nodiscard]] std::uint64_t work_bytes() const { return corner_count_ * index_bytes_; }
  /// Number of triangles, with those that are left out.
  [[nodiscard]] std::uint64_t count() const { return triangle_count_; }
  /// Number of indices behind the last triangle.
  [[nodiscard]] std::uint64_t rest() const {
    return mode_ == GltfMode::kTriangles ? corner_count_ % 3 : 0;
  }

  /// Calls take() for each triangle; see FaceVertexJoin::deliver().
  ///
  /// work_before  bytes of the work that was done for other primitives: offsets of positions begin
  ///              there.
  /// emitter      is told the progress.
  template <class Take>
  Result<FacePosition> each(const FacePosition& from, std::uint64_t work_before,
                            FanEmitter& emitter, const Take& take) {
    std::uint64_t record = from.record;
    std::uint64_t work = from.position.offset;
    std::uint64_t triangle = (work - work_before) / bytes_per_triangle();
    for (; triangle < triangle_count_; ++triangle) {
      std::array<std::int64_t, 3> vertices;
      if (!read(triangle, vertices)) return *failure_;
      const bool is_taken = mode_ == GltfMode::kTriangles || !names_twice(vertices);
      const Result<bool> taken = is_taken ? take(IndexedFace(record, vertices)) : true;
      if (!taken) return taken.error();
      if (!*taken) break;
      if (is_taken) ++record;
      work += bytes_per_triangle();
      if (const auto told = emitter.advance(work); !told) return told.error();
    }
    return FacePosition{{work, 0}, record, 0};
  }

 private:
  [[nodiscard]] std::uint64_t bytes_per_triangle() const {
    return index_bytes_ * (mode_ == GltfMode::kTriangles ? 3 : 1);
  }
  static bool names_twice(const std::array<std::int64_t, 3>& vertices) {
    const auto& [a, b, c] = vertices;
    return a == b || b == c || c == a;
  }
  /// The corners of a triangle, as positions in the list of indices.
  [[nodiscard]] std::array<std::uint64_t, 3> corners_of(std::uint64_t triangle) const;
  bool read(std::uint64_t triangle, std::array<std::int64_t, 3>& vertices);
  bool read_index(std::uint64_t k, std::int64_t& index);

  const GltfMode mode_;
  const bool is_turned_;
  const ScalarType type_;
  const std::uint64_t index_bytes_, corner_count_, triangle_count_;
  std::optional<GltfElementReader> indices_;
  std::optional<std::int64_t> hub_;  ///< the vertex that all triangles of a fan share
  std::optional<Error> failure_;
};

}  // namespace planetree::octree
