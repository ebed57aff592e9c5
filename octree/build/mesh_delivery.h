#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "octree/build/mesh_reader.h"
#include "planetree/error.h"
#include "planetree/types.h"

namespace planetree::octree {

/// A corner as a format's reader found it.
struct MeshCorner {
  Vec3 position;           ///< meaningless unless in_range
  std::int64_t value = 0;  ///< how the file names its vertex; see SetAside::value
  bool in_range = true;    ///< the vertex exists
};

/// Hands polygons to a sink as fans: the one place that counts triangle
/// indices, judges records and reports progress, for all formats.
class MeshDelivery {
 public:
  MeshDelivery(TriangleSink& sink, RecordKind kind, std::uint64_t bytes_total)
      : sink_(sink), kind_(kind), bytes_total_(bytes_total) {}

  /// Vertices in the file, as far as they are known; for messages and summary.
  void set_vertex_count(std::uint64_t count) noexcept { vertex_count_ = count; }

  /// Delivers the record's fan, or sets the record aside.
  ///
  /// corner_at  (k) -> MeshCorner for k in [0, corner_count), the same each
  ///            time: a record is judged whole before any of it is delivered.
  /// return     the sink's error, if it gave one.
  template <class CornerAt>
  Result<void> polygon(std::uint64_t record, std::uint64_t corner_count,
                       const CornerAt& corner_at) {
    ++record_count_;
    if (corner_count < 3) {
      set_aside(record, corner_count, RecordFault::kTooFewCorners,
                static_cast<std::int64_t>(corner_count));
      return {};
    }
    std::array<Vec3, 3> corners;
    for (std::uint64_t k = 0; k < corner_count; ++k) {
      const MeshCorner corner = corner_at(k);
      if (const std::optional<RecordFault> fault = fault_of(corner)) {
        set_aside(record, corner_count, *fault, corner.value);
        return {};
      }
      if (k < 3) corners[k] = without_negative_zero(corner.position);
    }
    Result<void> taken = sink_.triangle(next_index_++, corners);
    for (std::uint64_t k = 3; k < corner_count && taken; ++k) {
      corners[1] = corners[2];
      corners[2] = without_negative_zero(corner_at(k).position);
      taken = sink_.triangle(next_index_++, corners);
    }
    any_delivered_ = true;
    return taken;
  }

  /// Tells the sink how far the reading is, about every 4 MiB.
  void advance(std::uint64_t bytes_done) {
    if (bytes_done >= next_report_bytes_) report(bytes_done);
  }

  /// Call once all is read: the summary, or kBadInput if no triangle was found.
  Result<MeshSummary> finish(bool float32);

 private:
  static constexpr std::uint64_t kReportBytes = std::uint64_t{4} << 20;

  static std::optional<RecordFault> fault_of(const MeshCorner& corner) {
    if (!corner.in_range) return RecordFault::kIndexOutOfRange;
    const Vec3& p = corner.position;
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) return std::nullopt;
    return RecordFault::kVertexNotFinite;
  }

  /// Equal positions must have equal bits; -0 + 0 is +0, and all else stays.
  static Vec3 without_negative_zero(const Vec3& p) { return {p.x + 0.0, p.y + 0.0, p.z + 0.0}; }

  void set_aside(std::uint64_t record, std::uint64_t corner_count, RecordFault fault,
                 std::int64_t value);
  void report(std::uint64_t bytes_done);

  TriangleSink& sink_;
  RecordKind kind_;
  std::uint64_t bytes_total_;
  std::uint64_t next_report_bytes_ = kReportBytes;
  std::uint64_t vertex_count_ = 0;
  std::uint64_t record_count_ = 0;
  std::uint64_t next_index_ = 0;
  bool any_delivered_ = false;
  std::optional<SetAside> first_set_aside_;
};

}  // namespace planetree::octree
