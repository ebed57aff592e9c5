#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_scratch.h"
#include "octree/builder/mesh/stream/mesh_vertices.h"

namespace planetree::octree {

/// Vertices of a text file. They are stored as they are read: in memory up to a limit, then in a
/// temporary file.
class TextVertices final : public MeshVertices {
 public:
  /// file     the mesh; its size limits the number of vertices.
  /// scratch  must outlive this.
  TextVertices(const MeshFile& file, bool float32, MeshScratch& scratch);

  /// Adds the next vertex. Call finish() after the last one, and read() only then.
  /// errors  those of SpillFile::append().
  Result<void> add(const Vec3& position);
  Result<void> finish();

  [[nodiscard]] std::uint64_t count() const override { return count_; }
  [[nodiscard]] bool float32() const override { return float32_; }
  Result<void> read(std::uint64_t first, std::span<std::byte> out) override;

 private:
  const bool float32_;
  ScratchFile file_;
  std::vector<std::byte> last_;  ///< positions that are not in file_ yet
  std::uint64_t count_ = 0;
};

}  // namespace planetree::octree
