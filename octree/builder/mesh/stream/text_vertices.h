#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/mesh_vertices.h"

namespace planetree::octree {

/// Vertices that were numbers of a text: put away as they are read, in memory as far as allowed
/// and in a temporary file beyond.
class TextVertices final : public MeshVertices {
 public:
  /// file     that they are read from: its size bounds their number.
  /// scratch  must outlive this.
  TextVertices(const MeshFile& file, bool float32, MeshScratch& scratch);

  /// Adds the next. After the last one finish(), and only then read().
  /// errors  those of SpillFile::append().
  Result<void> add(const Vec3& position);
  Result<void> finish();

  [[nodiscard]] std::uint64_t count() const override { return count_; }
  [[nodiscard]] bool float32() const override { return float32_; }
  Result<void> read(std::uint64_t first, std::span<std::byte> out) override;

 private:
  const bool float32_;
  ScratchFile file_;
  std::vector<std::byte> last_;  ///< not yet put away
  std::uint64_t count_ = 0;
};

}  // namespace planetree::octree
