#include "tools/points/ply_points.h"

#include <algorithm>
#include <cinttypes>
#include <string_view>

#include "octree/builder/mesh/header_prefix.h"
#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::tools {
namespace {

using octree::PlyElement;
using octree::PlyEncoding;
using octree::PlyHeader;

constexpr std::string_view kNoFaces = "element face 0\nproperty list uchar int vertex_indices\n";
constexpr std::uint64_t kNoFacesLines = 2;

Error bad_header(const char* cause) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere, "%s", cause);
}

/// Parses the header of a file with or without faces. The mesh reader's parser requires a face
/// element, so that a header without one is parsed with an element of 0 faces inserted.
Result<PlyHeader> parse_header(std::string_view file) {
  const bool carriage_returns = file.size() > 3 && file[3] == '\r' && file.substr(4, 1) != "\n";
  octree::LineScanner lines(
      file, {}, carriage_returns ? octree::LineEnd::kCarriageReturn : octree::LineEnd::kNewline);
  while (lines.next()) {
    std::string_view rest = lines.line();
    const std::string_view keyword = octree::take_word(rest);
    if (keyword == "element" && octree::take_word(rest) == "face") break;
    if (keyword != "end_header") continue;
    std::string inserted(kNoFaces);
    if (carriage_returns) std::replace(inserted.begin(), inserted.end(), '\n', '\r');
    std::string copy(file.substr(0, lines.position().offset));
    copy += inserted;
    copy += file.substr(lines.position().offset, lines.after().offset - lines.position().offset);
    auto header = octree::parse_ply_header(copy);
    if (!header) return header;
    header->body.offset -= inserted.size();
    header->body.line -= kNoFacesLines;
    return header;
  }
  return octree::parse_ply_header(file);
}

/// Parses a value. A float property is rounded once, to float, as the mesh reader does, so that the
/// vertices of a mesh lie on the mesh.
bool parse_number(const octree::PlyProperty& property, std::string_view word, double& value) {
  if (property.is_list || property.type != octree::ScalarType::kFloat32)
    return octree::parse_real(word, value);
  float rounded = 0;
  if (!octree::parse_real(word, rounded)) return false;
  value = static_cast<double>(rounded);
  return true;
}

}  // namespace

Result<std::unique_ptr<PointReader>> PlyPoints::create(const std::string& path,
                                                       octree::MeshFile file) {
  auto header = octree::parse_prefix(file, parse_header);
  if (!header) return header.error();
  std::unique_ptr<PlyPoints> points(new PlyPoints(path, std::move(file), *std::move(header)));
  if (const auto found = points->find_vertices(); !found) return found.error();
  return std::unique_ptr<PointReader>(std::move(points));
}

PlyPoints::PlyPoints(std::string name, octree::MeshFile file, PlyHeader header)
    : PointReader(std::move(name)),
      file_(std::move(file)),
      header_(std::move(header)),
      lines_(file_, header_.body),
      window_(file_),
      offset_(header_.body.offset),
      vertices_left_(header_.vertices().count) {}

/// Skips the elements before the vertices.
Result<void> PlyPoints::find_vertices() {
  for (std::size_t i = 0; i < header_.vertex_element; ++i) {
    const PlyElement& element = header_.elements[i];
    if (header_.encoding == PlyEncoding::kAscii) {
      for (std::uint64_t record = 0; record < element.count && lines_.next_filled(); ++record) {
      }
      continue;
    }
    const std::uint64_t record_bytes = std::max<std::uint64_t>(element.min_record_bytes(), 1);
    if (element.has_list() && element.count > 0)
      return bad_header("an element with lists precedes the vertices; write the vertices first");
    if (element.count > (file_.size_bytes() - offset_) / record_bytes)
      return bad_header("the file ends before the vertices; export it again");
    offset_ += element.count * element.min_record_bytes();
  }
  if (header_.encoding == PlyEncoding::kAscii) return {};
  if (header_.vertices().has_list()) return bad_header("the vertices have a list; leave it out");
  record_bytes_ = header_.vertices().min_record_bytes();
  for (std::size_t axis = 0; axis < 3; ++axis)
    coordinate_offsets_[axis] = header_.vertices().offset_of(header_.coordinates[axis]);
  return check_length();
}

Result<void> PlyPoints::check_length() const {
  if (vertices_left_ <= (file_.size_bytes() - offset_) / record_bytes_) return {};
  return make_error(ErrorCode::kBadInput, Error::kNowhere, file_.size_bytes(),
                    "the file ends in the middle of its %" PRIu64 " vertices; export it again",
                    vertices_left_);
}

Result<std::size_t> PlyPoints::read(std::span<Vec3> points) {
  if (failure_) return *failure_;
  const auto count =
      static_cast<std::size_t>(std::min<std::uint64_t>(points.size(), vertices_left_));
  const bool is_ascii = header_.encoding == PlyEncoding::kAscii;
  for (std::size_t i = 0; i < count; ++i) {
    const auto read = is_ascii ? read_line(points[i]) : read_record(points[i]);
    if (read) continue;
    failure_ = read.error();
    if (i == 0) return *failure_;
    return i;  // the error is reported after the points before it
  }
  vertices_left_ -= count;
  return count;
}

Result<void> PlyPoints::read_record(Vec3& point) {
  const bool swap = header_.encoding == PlyEncoding::kBinaryBigEndian;
  const std::byte* const record = window_.at(offset_, record_bytes_);
  if (record == nullptr) return window_.failure();
  double* const values[] = {&point.x, &point.y, &point.z};
  for (std::size_t axis = 0; axis < 3; ++axis)
    *values[axis] =
        octree::load_real(header_.coordinate_type(axis), record + coordinate_offsets_[axis], swap);
  offset_ += record_bytes_;
  return {};
}

Error PlyPoints::refusal(const char* cause) const {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "line %" PRIu64 ": %s; export the file again", lines_.position().line, cause);
}

Result<void> PlyPoints::read_line(Vec3& point) {
  if (!lines_.next_filled())
    return lines_.failure() ? *lines_.failure() : refusal("the file ends before its last vertex");
  std::string_view rest = lines_.line();
  double* const values[] = {&point.x, &point.y, &point.z};
  const auto& properties = header_.vertices().properties;
  for (std::size_t i = 0; i < properties.size(); ++i) {
    double value = 0;
    if (!parse_number(properties[i], octree::take_word(rest), value))
      return refusal("a vertex does not have the values that the header declares");
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (header_.coordinates[axis] == i) *values[axis] = value;
    if (!properties[i].is_list) continue;
    for (double item = 0; item < value; ++item)
      if (octree::take_word(rest).empty())
        return refusal("a vertex's list is shorter than its count");
  }
  return {};
}

}  // namespace planetree::tools
