#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "octree/builder/mesh/stream/corner_attributes.h"
#include "octree/builder/mesh/stream/polygon_triangulator.h"
#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/error.h"
#include "planetree/types.h"

namespace planetree::octree {

/// A corner as the reader of a format found it.
struct MeshCorner {
  Vec3 position;           ///< meaningless unless in_range
  std::int64_t value = 0;  ///< how the file names its vertex; see SkippedRecord::value
  bool in_range = true;    ///< whether the vertex exists
  CornerAttributes attributes = {};
};

/// Splits polygons into triangles (PolygonTriangulator) and hands these to a sink. Counts triangle
/// indices, judges records and reports progress for all formats.
class FanEmitter {
 public:
  FanEmitter(TriangleSink& sink, RecordKind kind, std::uint64_t bytes_total)
      : sink_(sink), kind_(kind), bytes_total_(bytes_total) {}

  /// Sets the number of vertices in the file, as far as it is known; for messages and the summary.
  void set_vertex_count(std::uint64_t count) noexcept { vertex_count_ = count; }

  /// Delivers attributes with each triangle, of which `keep` names those that are read.
  void set_keep(std::uint32_t keep) noexcept { keep_ = keep & kMeshAttributes; }
  [[nodiscard]] std::uint32_t keep() const noexcept { return keep_; }
  /// Sets the value of the triangles of the next records; see TriangleAttributes::value.
  void set_value(std::uint64_t value) noexcept { value_ = value; }

  /// Delivers the triangles of a record, or skips the record.
  ///
  /// corners  first(k, corner) is called for k from 0 on until the record is judged, which is
  ///          before any of it is delivered. Of a record that is too long to be kept in memory,
  ///          again(k, corner) is then called for k from 3 on. Both return false if the corner
  ///          cannot be read.
  /// return   false if a corner could not be read; nothing was delivered if it was in first().
  ///          Otherwise true, or the sink's error.
  template <class Corners>
  Result<bool> polygon_of(std::uint64_t record, std::uint64_t corner_count, Corners& corners) {
    if (corner_count < 3) {
      ++record_count_;
      skipped(record, corner_count, RecordFault::kTooFewCorners,
              static_cast<std::int64_t>(corner_count));
      return true;
    }
    const bool is_polygon = corner_count > 3;
    const bool is_held = is_polygon && corner_count <= PolygonTriangulator::kMaxCorners;
    std::array<Vec3, 3> three;
    MeshCorner corner;
    held_.clear();
    held_attributes_.clear();
    for (std::uint64_t k = 0; k < corner_count; ++k) {
      if (!corners.first(k, corner)) return false;
      if (const std::optional<RecordFault> fault = fault_of(corner)) {
        ++record_count_;
        skipped(record, corner_count, *fault, corner.value);
        return true;
      }
      const Vec3 position = without_negative_zero(corner.position);
      if (is_held) {
        held_.push_back(position);
      } else if (k < 3) {
        three[k] = position;
      }
      if (keep_ != 0 && (is_held || k < 3)) held_attributes_.push_back(corner.attributes);
    }
    ++record_count_;
    any_delivered_ = true;
    if (is_held) {
      if (const auto taken = split(record); !taken) return taken.error();
      return true;
    }
    if (is_polygon) note_odd(record, corner_count, PolygonFault::kTooLong);
    Result<void> taken = deliver(three, {0, 1, 2});
    for (std::uint64_t k = 3; k < corner_count && taken; ++k) {
      if (!corners.again(k, corner)) return false;
      three[1] = three[2];
      three[2] = without_negative_zero(corner.position);
      if (keep_ != 0)
        held_attributes_ = {held_attributes_[0], held_attributes_[2], corner.attributes};
      taken = deliver(three, {0, 1, 2});
    }
    if (!taken) return taken.error();
    return true;
  }

  /// As polygon_of(), with all corners at hand.
  ///
  /// corner_at  (k) -> MeshCorner for k in [0, corner_count), the same each time.
  /// return     the sink's error, if there is one.
  template <class CornerAt>
  Result<void> polygon(std::uint64_t record, std::uint64_t corner_count,
                       const CornerAt& corner_at) {
    struct Corners {
      bool first(std::uint64_t k, MeshCorner& corner) {
        corner = corner_at(k);
        return true;
      }
      bool again(std::uint64_t k, MeshCorner& corner) { return first(k, corner); }
      const CornerAt& corner_at;
    } corners{corner_at};
    const Result<bool> taken = polygon_of(record, corner_count, corners);
    if (!taken) return taken.error();
    return {};
  }

  /// Reports progress to the sink, about every 4 MiB. Returns the sink's error, if there is one.
  Result<void> advance(std::uint64_t bytes_done) {
    const std::uint64_t done = bytes_done + bytes_before_;
    return done < next_report_bytes_ ? Result<void>() : report(done);
  }
  /// Adds work to the total, counted in bytes of the file.
  void expect_more(std::uint64_t bytes) { bytes_total_ += bytes; }
  /// Adds `bytes` to all later values of advance(), which then counts from an earlier position
  /// again.
  void begin_again(std::uint64_t bytes) { bytes_before_ += bytes; }
  [[nodiscard]] std::uint64_t bytes_total() const { return bytes_total_; }

  /// Ends the reading. Returns the summary, kBadInput if there was no usable triangle, or the
  /// sink's error.
  Result<MeshSummary> finish(bool float32);

 private:
  static constexpr std::uint64_t kReportBytes = std::uint64_t{4} << 20;

  static std::optional<RecordFault> fault_of(const MeshCorner& corner) {
    if (!corner.in_range) return RecordFault::kIndexOutOfRange;
    const Vec3& p = corner.position;
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) return std::nullopt;
    return RecordFault::kVertexNotFinite;
  }

  /// Equal positions must have equal bits: -0 + 0 is +0, and other numbers stay the same.
  static Vec3 without_negative_zero(const Vec3& p) { return {p.x + 0.0, p.y + 0.0, p.z + 0.0}; }

  void skipped(std::uint64_t record, std::uint64_t corner_count, RecordFault fault,
               std::int64_t value);
  Result<void> report(std::uint64_t bytes_done);
  /// Delivers a triangle. `held` names the corners' attributes in held_attributes_.
  Result<void> deliver(const std::array<Vec3, 3>& corners, const CornerTriple& held) {
    const Result<void> taken = sink_.triangle(next_index_++, corners);
    return taken && keep_ != 0 ? deliver_attributes(held) : taken;
  }
  Result<void> deliver_attributes(const CornerTriple& held);
  Result<void> deliver_held(const CornerTriple& held);
  /// Delivers the polygon of the corners in held_.
  Result<void> split(std::uint64_t record);
  void note_odd(std::uint64_t record, std::uint64_t corner_count, PolygonFault fault);

  TriangleSink& sink_;
  RecordKind kind_;
  std::uint64_t bytes_total_;
  std::uint64_t bytes_before_ = 0;
  std::uint64_t next_report_bytes_ = kReportBytes;
  std::uint64_t vertex_count_ = 0;
  std::uint64_t record_count_ = 0;
  std::uint64_t next_index_ = 0;
  bool any_delivered_ = false;
  std::optional<SkippedRecord> first_skipped_;
  std::uint32_t keep_ = 0;
  std::uint64_t value_ = 0;
  std::vector<Vec3> held_;                         ///< corners of a polygon
  std::vector<CornerAttributes> held_attributes_;  ///< of these, or of a triangle
  PolygonTriangulator triangulator_;
  OddPolygons odd_;
};

}  // namespace planetree::octree
