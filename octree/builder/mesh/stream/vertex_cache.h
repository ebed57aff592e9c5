#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "octree/builder/mesh/stream/mesh_vertices.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Caches blocks of neighbouring vertices, or other records, that were used lately. Vertices that
/// faces close together share are read about once; each vertex is read at most once if all fit.
///
/// A block belongs to one of several sets, where it replaces the least recently used block. If all
/// blocks fit, each has a slot of its own.
class VertexCache {
 public:
  /// vertices      complete; must outlive this.
  /// memory_bytes  approximate maximum of memory, taken as it is needed.
  VertexCache(MeshRecords& vertices, std::uint64_t memory_bytes);
  VertexCache(const VertexCache&) = delete;
  VertexCache& operator=(const VertexCache&) = delete;

  /// Record of a vertex below count(), valid until the next call. Null if it cannot be read: see
  /// failure().
  const std::byte* at(std::uint64_t vertex) {
    const std::uint64_t block = vertex >> block_shift_;
    Slot*& slot = known_[block % kKnown];
    if (slot->block != block && !enter(block, slot)) return nullptr;
    slot->used = ++clock_;
    return slot->records.get() +
           (vertex & ((std::uint64_t{1} << block_shift_) - 1)) * record_bytes_;
  }
  [[nodiscard]] const Error& failure() const { return *failure_; }

  /// Capacity, and bytes that were read so far.
  [[nodiscard]] std::uint64_t capacity_bytes() const { return slots_.size() * block_bytes(); }
  [[nodiscard]] std::uint64_t read_bytes() const { return read_bytes_; }

 private:
  static constexpr std::size_t kWays = 8;
  static constexpr std::size_t kKnown = 16;
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};

  struct Slot {
    std::uint64_t block = kNone;
    std::uint64_t used = 0;  ///< clock_ at the last use
    std::unique_ptr<std::byte[]> records;
  };

  [[nodiscard]] std::uint64_t block_bytes() const { return record_bytes_ << block_shift_; }
  bool enter(std::uint64_t block, Slot*& slot);
  bool load(std::uint64_t block, Slot& slot);

  MeshRecords& vertices_;
  const std::size_t record_bytes_;
  int block_shift_ = 0;                   ///< a block has 2^block_shift_ vertices
  std::vector<Slot> slots_;               ///< the slots of a set are side by side
  std::size_t ways_ = 1;                  ///< slots of a set
  std::array<Slot*, kKnown> known_ = {};  ///< slots to try first
  std::uint64_t clock_ = 0;
  std::uint64_t read_bytes_ = 0;
  std::optional<Error> failure_;
};

}  // namespace planetree::octree
