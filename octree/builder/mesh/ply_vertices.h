#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_vertices.h"

namespace planetree::octree {

/// The vertices of a binary PLY body: records of one size, found by multiplying and read where
/// they are.
class PlyVertices final : public MeshVertices {
 public:
  /// Both must outlive this.
  PlyVertices(const MeshFile& file, const PlyHeader& header, bool swap);

  /// Makes them known: that they begin at `offset` and are all in the file.
  void set(std::uint64_t offset, std::uint64_t count) {
    begin_ = offset;
    count_ = count;
  }
  [[nodiscard]] std::uint64_t record_bytes() const { return record_bytes_; }

  [[nodiscard]] std::uint64_t count() const override { return count_; }
  [[nodiscard]] bool float32() const override { return float32_; }
  Result<void> read(std::uint64_t first, std::span<std::byte> out) override;

 private:
  [[nodiscard]] Vec3 position(const std::byte* record) const;

  const MeshFile& file_;
  const bool swap_;
  const bool float32_;
  std::uint64_t begin_ = 0, count_ = 0;
  std::uint64_t record_bytes_ = 0;
  std::array<std::uint64_t, 3> offsets_ = {};  ///< of x, y and z in a record
  std::array<PlyType, 3> types_ = {};
  bool plain_ = true;               ///< records are positions as they should be
  std::vector<std::byte> records_;  ///< as the file has them
};

}  // namespace planetree::octree
