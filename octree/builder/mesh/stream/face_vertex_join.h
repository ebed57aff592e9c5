#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "octree/builder/mesh/stream/corner_sort.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/stream/mesh_vertices.h"
#include "octree/builder/mesh/stream/vertex_cache.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Position of a face, from which a pass over the faces can begin.
struct FacePosition {
  TextPosition position;
  std::uint64_t record = 0;          ///< number of faces before it
  std::int64_t vertices_before = 0;  ///< OBJ only: number of vertices before it
  std::int64_t uvs_before = 0;       ///< OBJ only: number of texture vertices before it
};

/// Gives the corners of faces the records of their vertices and delivers the faces, in the order
/// of the input and within bounded memory whatever the order of the vertices is.
///
/// Vertices near those that were used lately are in memory. So a mesh whose faces refer to vertices
/// close together in the file is read once, from front to back. From the face on where references
/// are so scattered that sorting is cheaper, the rest of the faces is read twice: first the corners
/// are sorted to meet their vertices, then the faces are delivered.
///
/// A face is a class with
///   record(), size()       its number, and its number of corners,
///   value_at(k, value)     how the file names the vertex of corner k; false if it cannot be
///                          read, with the error in failure(),
///   vertices_before()      the number from which negative values of an OBJ count back,
///   uv_vertex(k)           the index of the texture vertex of corner k; not below their count if
///   it
///                          has none,
///   add_attributes(k, c)   sets attributes of corner k that the face itself has; false if they
///                          cannot be read, with the error in failure().
/// The last two are called if the emitter delivers attributes.
class FaceVertexJoin {
 public:
  /// vertices      complete; it, `scratch` and `emitter` must outlive this.
  /// first_number  the number of the first vertex in the file.
  /// is_text       whether the vertices take a part of the memory.
  /// uvs           records of a TextureCoordinate, which uv_vertex() names; null if vertices or
  ///               faces have them, or nothing has. Must outlive this.
  FaceVertexJoin(MeshVertices& vertices, std::int64_t first_number, MeshScratch& scratch,
                 bool is_text, FanEmitter& emitter, MeshRecords* uvs = nullptr);

  /// Delivers all faces.
  ///
  /// file_bytes  size of the file.
  /// each_face   (from, take) -> Result<FacePosition>: calls take(face), which returns
  ///             Result<bool>, for each face from `from` on, until it returns false. Returns the
  ///             position of that face, or the position behind the last face.
  /// errors      those of each_face, of the sink and of temporary files.
  template <class EachFace>
  Result<FacePosition> deliver(const FacePosition& begin, std::uint64_t file_bytes,
                               const EachFace& each_face) {
    cache_.emplace(vertices_, memory_bytes_);
    if (uvs_ != nullptr) uv_cache_.emplace(*uvs_, memory_bytes_);
    credit_bytes_ = max_credit_bytes();
    const Result<FacePosition> end =
        each_face(begin, [this](const auto& face) { return this->take_near(face); });
    if (!end || !over_limit_) return end;
    cache_.reset();
    uv_cache_.reset();
    return deliver_sorted(*end, file_bytes - end->position.offset, each_face);
  }

 private:
  /// Bytes of positions that may be read per corner. Sorting moves about four times as many, in few
  /// long reads.
  static constexpr std::uint64_t kCreditBytes = 16;

  /// Corners that are sorted by their vertices, and by their texture vertices if there are any.
  struct SortedRecords {
    CornerSort vertices;
    std::optional<CornerSort> uvs;
  };

  template <class Face>
  class NearCorners;
  template <class Face>
  class SortedCorners;

  template <class EachFace>
  Result<FacePosition> deliver_sorted(const FacePosition& begin, std::uint64_t rest_bytes,
                                      const EachFace& each_face);
  template <class Face>
  Result<bool> take_near(const Face& face);
  template <class Face>
  Result<bool> add_to(SortedRecords& sort, const Face& face);
  Result<void> add_uv(CornerSort& sort, std::uint64_t uv_vertex);
  template <class Face>
  Result<bool> take_sorted(SortedRecords& sort, std::uint64_t& next_corner, const Face& face);

  /// Index of the vertex that a value names; count() or more if there is none.
  [[nodiscard]] std::uint64_t vertex_of(std::int64_t value, std::int64_t vertices_before) const {
    return static_cast<std::uint64_t>(value < 0 ? value + vertices_before : value - first_number_);
  }
  [[nodiscard]] std::uint64_t max_credit_bytes() const {
    return 2 * (cache_->capacity_bytes() + (uv_cache_ ? uv_cache_->capacity_bytes() : 0));
  }
  [[nodiscard]] std::uint64_t read_bytes() const {
    return cache_->read_bytes() + (uv_cache_ ? uv_cache_->read_bytes() : 0);
  }
  [[nodiscard]] bool has_uv(std::uint64_t uv_vertex) const {
    return uvs_ != nullptr && uv_vertex < uvs_->count();
  }
  /// Sets a corner to the record of its vertex.
  void set_vertex(const std::byte* record, MeshCorner& corner) const {
    corner.position = position_at(record, float32_);
    if (has_attributes_)
      corner.attributes =
          attributes_at(record + vertices_.position_bytes(), vertices_.attributes());
  }
  static void set_uv(const std::byte* record, MeshCorner& corner) {
    corner.attributes.uv = attributes_at(record, kKeepUv).uv;
  }
  void begin_face(std::uint64_t corners);
  bool stop(const Error& failure) {
    failure_ = failure;
    return false;
  }

  MeshVertices& vertices_;
  const std::uint64_t vertex_count_;
  const bool float32_;
  const std::int64_t first_number_;
  MeshScratch& scratch_;
  MeshRecords* const uvs_;
  const std::uint64_t memory_bytes_;  ///< for the vertices, and as many for texture vertices
  const std::uint64_t credit_per_corner_;
  FanEmitter& emitter_;
  const bool has_attributes_;  ///< corners have attributes that are delivered
  std::optional<VertexCache> cache_, uv_cache_;
  std::uint64_t credit_bytes_ = 0;  ///< may still be read; grows with each corner
  std::uint64_t seen_bytes_ = 0;    ///< read_bytes() when the credit was updated
  std::uint64_t limit_bytes_ = 0;   ///< maximum of read_bytes() in this face
  bool over_limit_ = false;
  std::optional<Error> failure_;
};

/// The corners of a face, looked up in the vertex cache.
template <class Face>
class FaceVertexJoin::NearCorners {
 public:
  NearCorners(FaceVertexJoin& join, const Face& face) : join_(join), face_(face) {}

  bool first(std::uint64_t k, MeshCorner& corner) {
    if (!look_up(k, corner)) return false;
    if (join_.read_bytes() > join_.limit_bytes_) {
      join_.over_limit_ = true;
      return false;
    }
    return true;
  }
  bool again(std::uint64_t k, MeshCorner& corner) { return look_up(k, corner); }

 private:
  bool look_up(std::uint64_t k, MeshCorner& corner) {
    if (!face_.value_at(k, corner.value)) return join_.stop(face_.failure());
    const std::uint64_t vertex = join_.vertex_of(corner.value, face_.vertices_before());
    corner.in_range = vertex < join_.vertex_count_;
    if (!corner.in_range) return true;
    const std::byte* const record = join_.cache_->at(vertex);
    if (record == nullptr) return join_.stop(join_.cache_->failure());
    join_.set_vertex(record, corner);
    return !join_.has_attributes_ || add_attributes(k, corner);
  }
  bool add_attributes(std::uint64_t k, MeshCorner& corner) {
    if (const std::uint64_t uv = face_.uv_vertex(k); join_.has_uv(uv)) {
      const std::byte* const record = join_.uv_cache_->at(uv);
      if (record == nullptr) return join_.stop(join_.uv_cache_->failure());
      set_uv(record, corner);
    }
    return face_.add_attributes(k, corner.attributes) || join_.stop(face_.failure());
  }

  FaceVertexJoin& join_;
  const Face& face_;
};

/// The corners of a face, looked up among the sorted corners.
template <class Face>
class FaceVertexJoin::SortedCorners {
 public:
  SortedCorners(FaceVertexJoin& join, SortedRecords& sort, std::uint64_t first_corner,
                const Face& face)
      : join_(join), sort_(sort), first_corner_(first_corner), face_(face) {}

  bool first(std::uint64_t k, MeshCorner& corner) {
    if (!face_.value_at(k, corner.value)) return join_.stop(face_.failure());
    corner.in_range = join_.vertex_of(corner.value, face_.vertices_before()) < join_.vertex_count_;
    return !corner.in_range || again(k, corner);
  }
  bool again(std::uint64_t k, MeshCorner& corner) {
    const std::byte* const record = sort_.vertices.at(first_corner_ + k);
    if (record == nullptr) return join_.stop(sort_.vertices.failure());
    join_.set_vertex(record, corner);
    return !join_.has_attributes_ || add_attributes(k, corner);
  }

 private:
  bool add_attributes(std::uint64_t k, MeshCorner& corner) {
    if (sort_.uvs) {
      const std::byte* const record = sort_.uvs->at(first_corner_ + k);
      if (record == nullptr) return join_.stop(sort_.uvs->failure());
      set_uv(record, corner);
    }
    return face_.add_attributes(k, corner.attributes) || join_.stop(face_.failure());
  }

  FaceVertexJoin& join_;
  SortedRecords& sort_;
  const std::uint64_t first_corner_;
  const Face& face_;
};

template <class Face>
Result<bool> FaceVertexJoin::take_near(const Face& face) {
  begin_face(face.size());
  NearCorners<Face> corners(*this, face);
  Result<bool> taken = emitter_.polygon_of(face.record(), face.size(), corners);
  if (taken && !*taken && !over_limit_) return *failure_;
  return taken;
}

template <class Face>
Result<bool> FaceVertexJoin::add_to(SortedRecords& sort, const Face& face) {
  if (face.size() < 3) return true;
  for (std::uint64_t k = 0; k < face.size(); ++k) {
    std::int64_t value = 0;
    if (!face.value_at(k, value)) return face.failure();
    const std::uint64_t vertex = vertex_of(value, face.vertices_before());
    if (vertex >= vertex_count_) {
      sort.vertices.add_none();
    } else if (const auto added = sort.vertices.add(vertex); !added) {
      return added.error();
    }
    if (sort.uvs)
      if (const auto added = add_uv(*sort.uvs, face.uv_vertex(k)); !added) return added.error();
  }
  return true;
}

template <class Face>
Result<bool> FaceVertexJoin::take_sorted(SortedRecords& sort, std::uint64_t& next_corner,
                                         const Face& face) {
  SortedCorners<Face> corners(*this, sort, next_corner, face);
  if (face.size() >= 3) next_corner += face.size();
  Result<bool> taken = emitter_.polygon_of(face.record(), face.size(), corners);
  if (taken && !*taken) return *failure_;
  return taken;
}

template <class EachFace>
Result<FacePosition> FaceVertexJoin::deliver_sorted(const FacePosition& begin,
                                                    std::uint64_t rest_bytes,
                                                    const EachFace& each_face) {
  if (const auto may = scratch_.begin_sorting(); !may) return may.error();
  SortedRecords sort{CornerSort(vertices_, scratch_, memory_bytes_), std::nullopt};
  if (uvs_ != nullptr) sort.uvs.emplace(*uvs_, scratch_, memory_bytes_);
  const std::uint64_t bytes_before = emitter_.bytes_total();
  emitter_.expect_more(2 * rest_bytes);
  const auto added = each_face(begin, [&](const auto& face) { return this->add_to(sort, face); });
  if (!added) return added.error();
  const std::uint64_t share_bytes = rest_bytes / (sort.uvs ? 2 : 1);
  const auto match = [&](CornerSort& corners, std::uint64_t bytes) {
    return corners.match([&](std::uint64_t part, std::uint64_t parts) {
      return emitter_.advance(bytes + share_bytes / parts * part);
    });
  };
  if (const auto matched = match(sort.vertices, bytes_before); !matched) return matched.error();
  if (sort.uvs)
    if (const auto matched = match(*sort.uvs, bytes_before + share_bytes); !matched)
      return matched.error();
  emitter_.begin_again(2 * rest_bytes);
  std::uint64_t next_corner = 0;
  return each_face(begin,
                   [&](const auto& face) { return this->take_sorted(sort, next_corner, face); });
}

}  // namespace planetree::octree
