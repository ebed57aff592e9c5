#pragma once

#include <array>
#include <cstdint>

#include "octree/builder/job/model_frame.h"
#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/sort/core_box.h"

namespace planetree::octree {

/// Finds the frame of a mesh from its triangles in the order of the input.
class FrameFinder {
 public:
  /// Adds a triangle.
  void add(std::uint64_t index, const std::array<Vec3, 3>& corners);
  /// Adds a record that gives no triangle; see TriangleSink::skipped().
  void skip(std::uint64_t first_index, std::uint64_t count, const SkippedRecord& why);

  /// Whether some coordinate so far is not exactly a float.
  bool needs_float64() const { return frame_.float64; }
  /// Tells the core from strays, after the last triangle. It may have to be given all triangles
  /// again.
  CoreFinder core_finder() const {
    return CoreFinder(sample_, frame_.input_lower, frame_.input_upper);
  }
  /// Returns the frame. Call it once.
  ModelFrame found(const CoreFinder::Core& core);

 private:
  void widen_box(const std::array<Vec3, 3>& corners);
  void choose_scale();

  ModelFrame frame_;
  CornerSample sample_;
  double min_magnitude_ = 0;  // minimum over all coordinates that are not 0
};

/// A triangle with the corners that a sink received.
Triangle triangle_of(const std::array<Vec3, 3>& corners);

}  // namespace planetree::octree
