#pragma once

#include <cstdint>
#include <string>

#include "octree/geometry/triangle_distance.h"
#include "storage/file/file_layout.h"

namespace planetree::octree {

/// What reading a mesh found: its box, its core, its scale and its counts.
///
/// The core is the box of all triangles but the strays, which are few and far outside. Most models
/// have no strays; their core is their box. The model frame is the input's coordinates times a
/// power of two, so that the longest edge of the core lies in [1, 2).
struct ModelFrame {
  std::uint64_t triangle_count = 0;
  bool float64 = false;    ///< some coordinate of the input or the model frame needs float64
  int scale_exponent = 0;  ///< model frame = input * 2^scale_exponent
  Point input_lower = Point::Zero(), input_upper = Point::Zero();  ///< box in the input's units
  Point input_core_lower = Point::Zero(), input_core_upper = Point::Zero();  ///< core, likewise
  std::uint64_t stray_count = 0;       ///< triangles that are not in the core
  double stray_edge = 0;               ///< see storage::ModelRecord::stray_edge
  Point input_sample = Point::Zero();  ///< corner 0 of the first triangle, the input's units
  std::uint64_t sample_triangle = 0;   ///< index of that triangle
  std::uint64_t skipped_count = 0;     ///< triangle indices of skipped records
  std::uint64_t first_skipped = kNoTriangle;
  std::string first_skipped_text;
  std::uint64_t nonplanar_count = 0;  ///< polygons that are neither convex nor flat
  std::string first_nonplanar_text;
  std::uint64_t fanned_count = 0;  ///< polygons whose fans may reach beyond them
  std::string first_fanned_text;

  bool has_strays() const { return stray_count > 0; }
  /// Box in the model frame.
  Point lower() const { return scaled(input_lower); }
  Point upper() const { return scaled(input_upper); }
  /// Core in the model frame, and its centre.
  Point core_lower() const { return scaled(input_core_lower); }
  Point core_upper() const { return scaled(input_core_upper); }
  Point centre() const { return (core_lower() + core_upper()) * 0.5; }

  /// Converts a point of the input to the model frame. A coordinate that underflows to zero is +0.
  Point scaled(const Point& point) const;
};

}  // namespace planetree::octree
