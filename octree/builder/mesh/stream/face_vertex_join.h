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
};

/// Gives the corners of faces the positions of their vertices and delivers the faces, in the order
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
///   vertices_before()      the number from which negative values of an OBJ count back.
class FaceVertexJoin {
 public:
  /// vertices      complete; it, `scratch` and `emitter` must outlive this.
  /// first_number  the number of the first vertex in the file.
  /// is_text       whether the vertices take a part of the memory.
  FaceVertexJoin(MeshVertices& vertices, std::int64_t first_number, MeshScratch& scratch,
                 bool is_text, FanEmitter& emitter);

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
    credit_bytes_ = max_credit_bytes();
    const Result<FacePosition> end =
        each_face(begin, [this](const auto& face) { return this->take_near(face); });
    if (!end || !over_limit_) return end;
    cache_.reset();
    return deliver_sorted(*end, file_bytes - end->position.offset, each_face);
  }

 private:
  /// Bytes that may be read per corner. Sorting moves about four times as many, in few long reads.
  static constexpr std::uint64_t kCreditBytes = 16;

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
  Result<bool> add_to(CornerSort& sort, const Face& face);
  template <class Face>
  Result<bool> take_sorted(CornerSort& sort, std::uint64_t& next_corner, const Face& face);

  /// Index of the vertex that a value names; count() or more if there is none.
  [[nodiscard]] std::uint64_t vertex_of(std::int64_t value, std::int64_t vertices_before) const {
    return static_cast<std::uint64_t>(value < 0 ? value + vertices_before : value - first_number_);
  }
  [[nodiscard]] std::uint64_t max_credit_bytes() const { return 2 * cache_->capacity_bytes(); }
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
  const std::uint64_t memory_bytes_;
  FanEmitter& emitter_;
  std::optional<VertexCache> cache_;
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
    if (join_.cache_->read_bytes() > join_.limit_bytes_) {
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
    const std::byte* const position = join_.cache_->at(vertex);
    if (position == nullptr) return join_.stop(join_.cache_->failure());
    corner.position = position_at(position, join_.float32_);
    return true;
  }

  FaceVertexJoin& join_;
  const Face& face_;
};

/// The corners of a face, looked up among the sorted corners.
template <class Face>
class FaceVertexJoin::SortedCorners {
 public:
  SortedCorners(FaceVertexJoin& join, CornerSort& sort, std::uint64_t first_corner,
                const Face& face)
      : join_(join), sort_(sort), first_corner_(first_corner), face_(face) {}

  bool first(std::uint64_t k, MeshCorner& corner) {
    if (!face_.value_at(k, corner.value)) return join_.stop(face_.failure());
    corner.in_range = join_.vertex_of(corner.value, face_.vertices_before()) < join_.vertex_count_;
    return !corner.in_range || again(k, corner);
  }
  bool again(std::uint64_t k, MeshCorner& corner) {
    const std::byte* const position = sort_.at(first_corner_ + k);
    if (position == nullptr) return join_.stop(sort_.failure());
    corner.position = position_at(position, join_.float32_);
    return true;
  }

 private:
  FaceVertexJoin& join_;
  CornerSort& sort_;
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
Result<bool> FaceVertexJoin::add_to(CornerSort& sort, const Face& face) {
  if (face.size() < 3) return true;
  for (std::uint64_t k = 0; k < face.size(); ++k) {
    std::int64_t value = 0;
    if (!face.value_at(k, value)) return face.failure();
    const std::uint64_t vertex = vertex_of(value, face.vertices_before());
    if (vertex >= vertex_count_) {
      sort.add_none();
    } else if (const auto added = sort.add(vertex); !added) {
      return added.error();
    }
  }
  return true;
}

template <class Face>
Result<bool> FaceVertexJoin::take_sorted(CornerSort& sort, std::uint64_t& next_corner,
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
  CornerSort sort(vertices_, scratch_, memory_bytes_);
  const std::uint64_t bytes_before = emitter_.bytes_total();
  emitter_.expect_more(2 * rest_bytes);
  const auto added = each_face(begin, [&](const auto& face) { return this->add_to(sort, face); });
  if (!added) return added.error();
  const auto matched = sort.match([&](std::uint64_t part, std::uint64_t parts) {
    return emitter_.advance(bytes_before + rest_bytes / parts * part);
  });
  if (!matched) return matched.error();
  emitter_.begin_again(2 * rest_bytes);
  std::uint64_t next_corner = 0;
  return each_face(begin,
                   [&](const auto& face) { return this->take_sorted(sort, next_corner, face); });
}

}  // namespace planetree::octree
