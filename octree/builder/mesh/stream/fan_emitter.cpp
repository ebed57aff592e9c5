#include "octree/builder/mesh/stream/fan_emitter.h"

#include <algorithm>
#include <cinttypes>

namespace planetree::octree {
namespace {

const char* words_of(PolygonFault fault) {
  switch (fault) {
    case PolygonFault::kNotPlanar:
      return "is neither convex nor flat";
    case PolygonFault::kCrossing:
      return "crosses itself";
    case PolygonFault::kTooLong:
      return "is too long to be examined";
    case PolygonFault::kNone:
      break;
  }
  return "is as it should be";
}

}  // namespace

void FanEmitter::skipped(std::uint64_t record, std::uint64_t corner_count, RecordFault fault,
                         std::int64_t value) {
  const std::uint64_t index_count = corner_count < 3 ? 1 : corner_count - 2;
  const SkippedRecord why{kind_, fault, record, value, vertex_count_};
  if (!first_skipped_) first_skipped_ = why;
  sink_.skipped(next_index_, index_count, why);
  next_index_ += index_count;
}

Result<void> FanEmitter::split(std::uint64_t record) {
  const PolygonFault fault = triangulator_.split(held_);
  if (fault != PolygonFault::kNone) note_odd(record, held_.size(), fault);
  if (!triangulator_.is_fan()) {
    for (const CornerTriple& triangle : triangulator_.triangles())
      if (const auto taken = deliver_held(triangle); !taken) return taken;
    return {};
  }
  for (std::uint32_t k = 2; k < held_.size(); ++k)
    if (const auto taken = deliver_held({0, k - 1, k}); !taken) return taken;
  return {};
}

Result<void> FanEmitter::deliver_held(const CornerTriple& held) {
  const auto& [a, b, c] = held;
  return deliver({held_[a], held_[b], held_[c]}, held);
}

Result<void> FanEmitter::deliver_attributes(const CornerTriple& held) {
  TriangleAttributes attributes;
  for (std::size_t k = 0; k < held.size(); ++k) {
    attributes.colors[k] = held_attributes_[held[k]].color;
    attributes.uvs[k] = held_attributes_[held[k]].uv;
  }
  attributes.value = value_;
  return sink_.attributes(attributes);
}

void FanEmitter::note_odd(std::uint64_t record, std::uint64_t corner_count, PolygonFault fault) {
  const bool is_nonplanar = fault == PolygonFault::kNotPlanar;
  std::string& first = is_nonplanar ? odd_.first_nonplanar : odd_.first_fanned;
  if ((is_nonplanar ? odd_.nonplanar : odd_.fanned)++ > 0) return;
  first = record_name(kind_, record) + ": a polygon of " + std::to_string(corner_count) +
          " corners " + words_of(fault);
}

Result<void> FanEmitter::report(std::uint64_t bytes_done) {
  next_report_bytes_ = bytes_done + kReportBytes;
  return sink_.progress(bytes_done, bytes_total_);
}

Result<MeshSummary> FanEmitter::finish(bool float32) {
  if (record_count_ == 0) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "no triangle: the mesh has no faces; give a mesh, not points or lines");
  }
  if (!any_delivered_) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "no triangle: all %" PRIu64
                      " face records are bad, first %s; export it again",
                      record_count_, first_skipped_->text().c_str());
  }
  if (const auto told = sink_.progress(bytes_total_, bytes_total_); !told) return told.error();
  return MeshSummary{vertex_count_, record_count_, next_index_, float32, odd_};
}

}  // namespace planetree::octree
