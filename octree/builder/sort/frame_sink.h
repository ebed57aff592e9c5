#pragma once

#include <cstdint>

#include "octree/builder/job/build_progress.h"
#include "octree/builder/job/model_frame.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Receives the triangles of a mesh and finds its frame.
class FrameSink : public TriangleSink {
 public:
  /// Sets what is told of the reading; must outlive this. Without a call, nothing is told.
  void report_to(BuildProgress& progress) { progress_ = &progress; }

  Result<void> progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override {
    return progress_ ? progress_->progress(BuildPhase::kReading, bytes_done, bytes_total)
                     : Result<void>();
  }
  /// Returns the frame. Call it once, after the last triangle.
  virtual Result<ModelFrame> finish() = 0;

 private:
  BuildProgress* progress_ = nullptr;
};

}  // namespace planetree::octree
