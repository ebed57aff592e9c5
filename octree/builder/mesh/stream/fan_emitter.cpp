#include "octree/builder/mesh/stream/fan_emitter.h"

#include <algorithm>
#include <cinttypes>

namespace planetree::octree {

void FanEmitter::skipped(std::uint64_t record, std::uint64_t corner_count, RecordFault fault,
                         std::int64_t value) {
  const std::uint64_t index_count = corner_count < 3 ? 1 : corner_count - 2;
  const SkippedRecord why{kind_, fault, record, value, vertex_count_};
  if (!first_skipped_) first_skipped_ = why;
  sink_.skipped(next_index_, index_count, why);
  next_index_ += index_count;
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
  return MeshSummary{vertex_count_, record_count_, next_index_, float32};
}

}  // namespace planetree::octree
