#include "octree/builder/mesh/stream/triangle_sink.h"

#include <cinttypes>
#include <cstdio>

namespace planetree::octree {

namespace {

const char* kind_name(RecordKind kind) {
  switch (kind) {
    case RecordKind::kFace:
      return "face";
    case RecordKind::kFacet:
      return "facet";
    case RecordKind::kTriangle:
      return "triangle";
    case RecordKind::kLine:
      break;
  }
  return "line";
}

}  // namespace

Result<void> TriangleSink::attributes(const TriangleAttributes&) { return {}; }

std::string record_name(RecordKind kind, std::uint64_t record) {
  return std::string(kind_name(kind)) + " " + std::to_string(record);
}

std::string SkippedRecord::text() const {
  char cause[128] = {};
  const bool names_corners = kind == RecordKind::kFacet || kind == RecordKind::kTriangle;
  switch (fault) {
    case RecordFault::kVertexNotFinite:
      std::snprintf(cause, sizeof cause, "%s %" PRId64 " is not finite",
                    names_corners ? "corner" : "vertex", value);
      break;
    case RecordFault::kIndexOutOfRange:
      std::snprintf(cause, sizeof cause,
                    "vertex index %" PRId64 " is out of range, the mesh has %" PRIu64 " vertices",
                    value, vertex_count);
      break;
    case RecordFault::kTooFewCorners:
      std::snprintf(cause, sizeof cause, "has %" PRId64 " corners, fewer than 3", value);
      break;
  }
  char line[192] = {};
  std::snprintf(line, sizeof line, "%s: %s", record_name(kind, record).c_str(), cause);
  return file == nullptr ? line : *file + ": " + line;
}

}  // namespace planetree::octree
