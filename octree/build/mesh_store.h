#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "octree/build/mesh_reader.h"
#include "octree/triangle_distance.h"
#include "storage/file_layout.h"

namespace planetree::octree {

/// The triangles of a model, held in memory in the order of the input.
///
/// Filled as a sink, so that no coordinate is -0; normalise() then moves them to
/// the model frame, where the longest box edge lies in [1, 2). Coordinates are
/// kept as float32 for as long as every one of them is a float32 there, so that
/// scanned models take 36 bytes a triangle. At most 2^32 - 1 triangles.
class MeshStore final : public TriangleSink {
 public:
  using ProgressCall = void (*)(void* context, std::uint64_t done, std::uint64_t total);

  MeshStore() = default;
  void report_progress(ProgressCall call, void* context) {
    progress_ = call;
    progress_context_ = context;
  }

  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override;
  void set_aside(std::uint64_t first_index, std::uint64_t count, const SetAside& why) override;
  void progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override;

  /// Scales all coordinates by a power of two. Call once, after reading.
  void normalise();

  std::uint32_t size() const { return static_cast<std::uint32_t>(count_); }
  /// Corner positions of triangle `position`; model frame once normalised.
  Triangle corners(std::uint32_t position) const;
  /// Index in the input of triangle `position`; ascending.
  std::uint64_t index(std::uint32_t position) const;

  bool float64() const { return float64_; }
  int scale_exponent() const { return scale_exponent_; }
  const Point& input_lower() const { return input_lower_; }
  const Point& input_upper() const { return input_upper_; }
  /// Box in the model frame.
  Point lower() const;
  Point upper() const;

  std::uint64_t set_aside_count() const { return set_aside_count_; }
  std::uint64_t first_set_aside() const { return first_set_aside_; }
  const std::string& first_set_aside_text() const { return first_set_aside_text_; }

 private:
  void widen();
  void choose_scale();

  std::uint64_t count_ = 0;
  bool float64_ = false;
  std::vector<float> narrow_;  ///< 9 coordinates a triangle, or
  std::vector<double> wide_;   ///< the same
  /// Where indices skip: from `position` on, index = position + `skipped`.
  struct Gap {
    std::uint64_t position;
    std::uint64_t skipped;
  };
  std::vector<Gap> gaps_;
  std::uint64_t set_aside_count_ = 0;
  std::uint64_t first_set_aside_ = kNoTriangle;
  std::string first_set_aside_text_;
  double least_magnitude_ = 0;  ///< of any coordinate but 0
  Point input_lower_ = Point::Zero();
  Point input_upper_ = Point::Zero();
  int scale_exponent_ = 0;
  ProgressCall progress_ = nullptr;
  void* progress_context_ = nullptr;
};

}  // namespace planetree::octree
