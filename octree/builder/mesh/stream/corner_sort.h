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

/// Positions of corners that name vertices in any order, within bounded memory: corners are
/// dealt out by vertex, meet the vertices, which are read once and in order, and are dealt out
/// again by their own numbers.
///
/// disk  what disk_bytes() says, as long as this lives.
class CornerSort {
 public:
  /// vertices      all known; both must outlive this.
  /// memory_bytes  about the most to take.
  CornerSort(MeshVertices& vertices, MeshScratch& scratch, std::uint64_t memory_bytes);

  /// What so many corners take on disk.
  static std::uint64_t disk_bytes(std::uint64_t corners, bool float32);

  /// Adds the next corner, from number 0 on, of a vertex below count().
  Result<void> add(std::uint64_t vertex);
  /// Adds one that names no vertex: it takes a number.
  void add_none() { ++corner_count_; }

  /// Call once, after the last corner.
  /// done  told how many of how many parts of the vertices are.
  Result<void> match(const std::function<void(std::uint64_t, std::uint64_t)>& done);

  /// The position of a corner that has a vertex, until the next call; fast where numbers
  /// ascend. Null: failure() says why.
  const std::byte* at(std::uint64_t corner) {
    const std::uint64_t part = corner >> part_shift_;
    if (corner >= corner_count_ || (part != loaded_ && !load(part))) return missing(corner);
    return positions_.data() + (corner & part_mask()) * position_bytes_;
  }
  [[nodiscard]] const Error& failure() const { return *failure_; }

 private:
  [[nodiscard]] std::uint64_t part_mask() const { return (std::uint64_t{1} << part_shift_) - 1; }
  [[nodiscard]] std::size_t parts_of(std::uint64_t count) const {
    return static_cast<std::size_t>((count >> part_shift_) + 1);
  }
  Result<void> match_part(std::size_t part);
  Result<void> position(const std::byte* corner);
  bool load(std::uint64_t part);
  const std::byte* missing(std::uint64_t corner);

  MeshVertices& vertices_;
  MeshScratch& scratch_;
  const std::size_t position_bytes_;
  const std::uint64_t buffer_bytes_;  ///< of one dealing out
  int part_shift_ = 0;                ///< a part is 2^part_shift_ vertices or corners, in memory
  std::uint64_t corner_count_ = 0;

  // Corners are in the first until match(), then in the second.
  std::optional<ScratchFile> by_vertex_file_;
  std::optional<storage::SpillBuckets> by_vertex_;
  std::optional<ScratchFile> by_corner_file_;
  std::optional<storage::SpillBuckets> by_corner_;

  std::vector<std::byte> positions_;  ///< of a part
  std::uint64_t loaded_ = ~std::uint64_t{0};
  std::optional<Error> failure_;
};

}  // namespace planetree::octree
