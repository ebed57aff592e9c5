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
    for (const auto& [a, b, c] : triangulator_.triangles())
      if (const auto taken = sink_.triangle(next_index_++, {held_[a], held_[b], held_[c]}); !taken)
        return taken;
    return {};
  }
  for (std::size_t k = 2; k < held_.size(); ++k)
    if (const auto taken = sink_.triangle(next_index_++, {held_[0], held_[k - 1], held_[k]});
        !taken)
      return taken;
  return {};
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
