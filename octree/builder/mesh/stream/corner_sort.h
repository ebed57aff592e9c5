#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/mesh_vertices.h"
#include "planetree/error.h"
#include "storage/spill/spill_buckets.h"

namespace planetree::octree {

/// Finds the records of corners that name vertices in any order, within bounded memory. Corners
/// are distributed by vertex and joined with the vertices, which are read once and in order. Then
/// they are distributed again, by their own numbers.
///
/// disk  up to disk_bytes(), until this is destroyed.
class CornerSort {
 public:
  /// vertices      complete; both it and `scratch` must outlive this.
  /// memory_bytes  approximate maximum of memory.
  CornerSort(MeshRecords& vertices, MeshScratch& scratch, std::uint64_t memory_bytes);

  /// Bytes on disk for a number of corners.
  /// attributes  of the vertices, as MeshVertices::attributes().
  static std::uint64_t disk_bytes(std::uint64_t corners, bool float32,
                                  std::uint32_t attributes = 0);

  /// Adds the next corner, numbered from 0. `vertex` is below vertices.count().
  Result<void> add(std::uint64_t vertex);
  /// Adds a corner that names no vertex. It takes a number too.
  void add_none() { ++corner_count_; }

  /// Joins the corners with the vertices. Call it once, after the last corner.
  /// done  called with (completed parts, all parts) after each part of the vertices. Its error ends
  ///       the joining and is returned.
  Result<void> match(const std::function<Result<void>(std::uint64_t, std::uint64_t)>& done);

  /// Record of the vertex of a corner, valid until the next call; fast where numbers ascend. All
  /// bytes are zero if the corner has none. Null if it cannot be read: see failure().
  const std::byte* at(std::uint64_t corner) {
    const std::uint64_t part = corner >> part_shift_;
    if (corner >= corner_count_ || (part != loaded_ && !load(part))) return missing(corner);
    return records_.data() + (corner & part_mask()) * record_bytes_;
  }
  [[nodiscard]] const Error& failure() const { return *failure_; }

 private:
  [[nodiscard]] std::uint64_t part_mask() const { return (std::uint64_t{1} << part_shift_) - 1; }
  [[nodiscard]] std::size_t parts_of(std::uint64_t count) const {
    return static_cast<std::size_t>((count >> part_shift_) + 1);
  }
  Result<void> match_part(std::size_t part);
  Result<void> fill(const std::byte* corner);
  bool load(std::uint64_t part);
  const std::byte* missing(std::uint64_t corner);

  MeshRecords& vertices_;
  MeshScratch& scratch_;
  const std::size_t record_bytes_;
  const std::uint64_t buffer_bytes_;  ///< memory of one distribution
  int part_shift_ = 0;                ///< a part has 2^part_shift_ vertices or corners, in memory
  std::uint64_t corner_count_ = 0;

  // The first pair has the corners until match(), the second pair after it.
  std::optional<ScratchFile> by_vertex_file_;
  std::optional<storage::SpillBuckets> by_vertex_;
  std::optional<ScratchFile> by_corner_file_;
  std::optional<storage::SpillBuckets> by_corner_;

  std::vector<std::byte> records_;  ///< records of one part
  std::uint64_t loaded_ = ~std::uint64_t{0};
  std::optional<Error> failure_;
};

}  // namespace planetree::octree
