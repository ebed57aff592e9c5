#include "octree/builder/mesh/sequence/mesh_sequence.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace planetree::octree {
namespace {

const char* values_of(ValueKind kind) {
  switch (kind) {
    case ValueKind::kSigned:
      return "signed integers";
    case ValueKind::kReal:
      return "reals";
    case ValueKind::kUnsigned:
      break;
  }
  return "unsigned integers";
}

}  // namespace

MeshSequence::MeshSequence(std::vector<std::uint64_t> file_bytes, TriangleSink& next)
    : file_bytes_(std::move(file_bytes)),
      next_(next),
      bytes_total_(std::accumulate(file_bytes_.begin(), file_bytes_.end(), std::uint64_t{0})) {
  joined_.float32 = true;
}

void MeshSequence::begin_file(const std::filesystem::path& path) { path_ = path.string(); }

Result<void> MeshSequence::end_file(const MeshSummary& summary, std::uint32_t keep) {
  const std::size_t number = joined_.file_indices.size();
  if (number == 0) joined_.value_kind = summary.value_kind;
  if ((keep & kKeepValue) != 0 && summary.value_kind != joined_.value_kind)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "its values are %s, and those of the files before it are %s; give all files "
                      "values of one type, or build without --keep value",
                      values_of(summary.value_kind), values_of(joined_.value_kind));
  joined_.vertex_records += summary.vertex_records;
  joined_.face_records += summary.face_records;
  joined_.triangle_indices += summary.triangle_indices;
  joined_.float32 = joined_.float32 && summary.float32;
  add_polygons(summary.odd_polygons);
  for (const std::string& note : summary.notes) joined_.notes.push_back(named(note));
  joined_.file_indices.push_back(summary.triangle_indices);
  bytes_before_ += file_bytes_[number];
  return {};
}

void MeshSequence::add_polygons(const OddPolygons& polygons) {
  OddPolygons& all = joined_.odd_polygons;
  if (all.nonplanar == 0 && polygons.nonplanar > 0)
    all.first_nonplanar = named(polygons.first_nonplanar);
  if (all.fanned == 0 && polygons.fanned > 0) all.first_fanned = named(polygons.first_fanned);
  all.nonplanar += polygons.nonplanar;
  all.fanned += polygons.fanned;
}

Result<void> MeshSequence::triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) {
  return next_.triangle(joined_.triangle_indices + index, corners);
}

Result<void> MeshSequence::attributes(const TriangleAttributes& attributes) {
  return next_.attributes(attributes);
}

void MeshSequence::skipped(std::uint64_t first_index, std::uint64_t count,
                           const SkippedRecord& why) {
  SkippedRecord named_record = why;
  named_record.file = &path_;
  next_.skipped(joined_.triangle_indices + first_index, count, named_record);
}

// A reader may count other bytes than those of its file, and more as it goes on.
Result<void> MeshSequence::progress(std::uint64_t bytes_done, std::uint64_t bytes_total) {
  const std::uint64_t of_file = file_bytes_[joined_.file_indices.size()];
  const double part =
      bytes_total == 0
          ? 1
          : std::min(1.0, static_cast<double>(bytes_done) / static_cast<double>(bytes_total));
  const auto read = static_cast<std::uint64_t>(part * static_cast<double>(of_file));
  bytes_done_ = std::max(bytes_done_, bytes_before_ + std::min(read, of_file));
  return next_.progress(bytes_done_, bytes_total_);
}

}  // namespace planetree::octree
