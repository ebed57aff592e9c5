#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "octree/builder/job/model_frame.h"
#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/sort/core_box.h"
#include "octree/builder/sort/triangles.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// Receives the triangles of a mesh as they are read, and keeps them in batches: in memory up to a
/// limit, then on disk. The model frame is known after the last triangle.
///
/// threads  one while it is filled; then any number may take batches, each once.
class TriangleSpool final : public TriangleSink {
 public:
  using ProgressCall = Result<void> (*)(void* context, std::uint64_t done, std::uint64_t total);

  /// batch_triangles  1 to 2^31.
  /// held_bytes       maximum of batches in memory, besides the last two.
  /// file             receives the other batches; must outlive this.
  TriangleSpool(std::uint32_t batch_triangles, std::uint64_t held_bytes, storage::SpillFile& file)
      : batch_triangles_(batch_triangles), held_bytes_(held_bytes), file_(file) {}

  void report_progress(ProgressCall call, void* context) {
    progress_ = call;
    progress_context_ = context;
  }

  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override;
  void skipped(std::uint64_t first_index, std::uint64_t count, const SkippedRecord& why) override;
  Result<void> progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override;

  /// Ends the spool. Call it once, after the last triangle.
  Result<ModelFrame> finish();

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

  void note(const std::array<Vec3, 3>& corners);
  void widen_last();
  Result<void> spill_batch(Batch& batch);
  Result<void> find_core();
  void choose_scale();
  Result<Triangles> read_batch(const Batch& batch) const;

  const std::uint32_t batch_triangles_;
  std::uint64_t held_bytes_;
  storage::SpillFile& file_;
  std::vector<Batch> batches_;
  ModelFrame frame_;
  CornerSample sample_;
  double min_magnitude_ = 0;  // minimum over all coordinates that are not 0
  ProgressCall progress_ = nullptr;
  void* progress_context_ = nullptr;
};

}  // namespace planetree::octree
