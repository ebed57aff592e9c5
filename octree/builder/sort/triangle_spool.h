#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "octree/builder/job/model_frame.h"
#include "octree/builder/sort/frame_finder.h"
#include "octree/builder/sort/frame_sink.h"
#include "octree/builder/sort/triangles.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// Receives the triangles of a mesh as they are read, and keeps them in batches: in memory up to a
/// limit, then on disk. The model frame is known after the last triangle.
///
/// threads  one while it is filled; then any number may take batches, each once.
class TriangleSpool final : public FrameSink {
 public:
  /// batch_triangles  1 to 2^31.
  /// held_bytes       maximum of batches in memory, besides the last two.
  /// file             receives the other batches; must outlive this.
  TriangleSpool(std::uint32_t batch_triangles, std::uint64_t held_bytes, storage::SpillFile& file)
      : batch_triangles_(batch_triangles), held_bytes_(held_bytes), file_(file) {}

  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override;
  void skipped(std::uint64_t first_index, std::uint64_t count, const SkippedRecord& why) override;

  /// Ends the spool. Call it, or the other, once, after the last triangle.
  Result<ModelFrame> finish() override;
  /// Ends the spool of a part of a mesh.
  /// frame  that of the mesh.
  Result<void> finish_part(const ModelFrame& frame);

  std::size_t batch_count() const { return batches_.size(); }
  /// The triangles of a batch in the order of the input, in the model frame, with their codes.
  /// Releases the memory of the batch. Call it after finish().
  Result<Triangles> take_batch(std::size_t batch);

 private:
  struct Batch {
    Triangles held;  // if empty, the batch is `bytes` bytes at `offset` in the file
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;
    bool float64 = false;
  };

  void widen_last();
  Result<void> spill_batch(Batch& batch);
  Result<CoreFinder::Core> find_core() const;
  Result<Triangles> read_batch(const Batch& batch) const;

  const std::uint32_t batch_triangles_;
  std::uint64_t held_bytes_;
  storage::SpillFile& file_;
  std::vector<Batch> batches_;
  FrameFinder finder_;
  ModelFrame frame_;  // after the end
};

}  // namespace planetree::octree
