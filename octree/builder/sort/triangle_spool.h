#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "octree/builder/job/model_frame.h"
#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/sort/triangles.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// Takes a mesh as it is read, in chunks of so many triangles: in memory as far as allowed,
/// then on disk. What the chunks' model frame is, is known after the last.
///
/// threads  one while it is filled; then any number may take chunks, each once.
class MeshIntake final : public TriangleSink {
 public:
  using ProgressCall = void (*)(void* context, std::uint64_t done, std::uint64_t total);

  /// chunk_triangles  1 to 2^31.
  /// held_bytes       of chunks may stay in memory, besides the last two.
  /// file             takes the others; must outlive this.
  MeshIntake(std::uint32_t chunk_triangles, std::uint64_t held_bytes, storage::SpillFile& file)
      : chunk_triangles_(chunk_triangles), held_bytes_(held_bytes), file_(file) {}

  void report_progress(ProgressCall call, void* context) {
    progress_ = call;
    progress_context_ = context;
  }

  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override;
  void set_aside(std::uint64_t first_index, std::uint64_t count, const SetAside& why) override;
  void progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override;

  /// Call once, after the last triangle.
  Result<ModelFrame> finish();

  std::size_t chunk_count() const { return chunks_.size(); }
  /// A chunk's triangles, in the order of the input, in the model frame, with their codes. Its
  /// memory is no longer held. After finish() only.
  Result<Triangles> take_chunk(std::size_t chunk);

 private:
  struct Chunk {
    Triangles held;  // or, if empty, `bytes` at `offset` in the file
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
    bool float64 = false;
  };

  void note(const std::array<Vec3, 3>& corners);
  void widen_last();
  Result<void> put_away(Chunk& chunk);
  void choose_scale();

  const std::uint32_t chunk_triangles_;
  std::uint64_t held_bytes_;
  storage::SpillFile& file_;
  std::vector<Chunk> chunks_;
  ModelFrame frame_;
  double least_magnitude_ = 0;  // of any coordinate but 0
  ProgressCall progress_ = nullptr;
  void* progress_context_ = nullptr;
};

}  // namespace planetree::octree
