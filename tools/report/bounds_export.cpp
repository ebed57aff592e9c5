#include "tools/report/bounds_export.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "query/file/scale.h"
#include "tools/check/disc_rim.h"
#include "tools/check/tree_descent.h"

namespace planetree::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "records are written in place");

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;
constexpr std::size_t kSides = kRimSides / 2;  // of a polygon
// A corner of the polygon is this much farther from the axis than its sides.
constexpr double kCornerFactor = 1 / 0.96592582628906831;
constexpr std::uint32_t kBoxCorners = 8, kBoxFaces = 6;

enum class BoundKind : std::uint8_t { kNodeDisc, kBlockDisc, kBox };

constexpr std::array<std::array<std::uint8_t, 3>, 3> kKindColours = {
    {{16, 144, 237}, {243, 154, 37}, {150, 150, 150}}};

// Corners of a box by the bits x, y, z; seen from outside, faces are counterclockwise.
constexpr std::uint32_t kBoxFaceCorners[kBoxFaces][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

BoundKind kind_of(const TreePart& part) {
  if (!part.has_disc) return BoundKind::kBox;
  return part.is_block ? BoundKind::kBlockDisc : BoundKind::kNodeDisc;
}

/// Bytes that wait to be written. After a failure, nothing more is written.
class PlyStream {
 public:
  explicit PlyStream(OutputFile& file) : file_(file) {}

  template <class T>
  void put(const T& value) {
    const auto raw = std::as_bytes(std::span(&value, 1));
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
    if (bytes_.size() >= kPieceBytes) write_out();
  }
  void put(std::string_view text) {
    for (const char c : text) bytes_.push_back(static_cast<std::byte>(c));
  }
  Result<void> finish() {
    write_out();
    return state_;
  }

 private:
  void write_out() {
    if (state_) state_ = file_.write(bytes_);
    bytes_.clear();
  }

  OutputFile& file_;
  std::vector<std::byte> bytes_;
  Result<void> state_;
};

/// Writes one part after the other.
class BoundsWriter {
 public:
  BoundsWriter(const storage::ModelRecord& model, PlyStream& stream)
      : scale_(model.scale_exponent),
        centre_{model.centre[0], model.centre[1], model.centre[2]},
        stream_(stream) {}

  void put_header(const BoundsExport& found, std::uint32_t level) {
    stream_.put(std::string_view(fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment planetree: bounds of level {}\n"
        "comment kind 0 disc of a node, 1 disc of a block, 2 box\n"
        "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face {}\nproperty list uchar uint vertex_indices\nproperty uchar level\n"
        "property uchar kind\nproperty uint page\nend_header\n",
        level, found.vertices, found.faces)));
  }

  void put_vertices(const TreePart& part) {
    const auto middle = part.box.centre();
    if (kind_of(part) == BoundKind::kBox) {
      for (std::uint32_t corner = 0; corner < kBoxCorners; ++corner) {
        std::array<double, 3> at{};
        for (std::size_t i = 0; i < 3; ++i)
          at[i] = (corner >> i & 1) != 0 ? part.box.upper[i] : part.box.lower[i];
        put_vertex(at, BoundKind::kBox);
      }
      return;
    }
    const std::array<double, 3> normal = {part.disc.normal[0], part.disc.normal[1],
                                          part.disc.normal[2]};
    const RimDirections directions = rim_directions(normal);
    for (const float height : {part.disc.slab_lower, part.disc.slab_upper})
      for (std::size_t side = 0; side < kSides; ++side) {
        std::array<double, 3> at{};
        for (std::size_t i = 0; i < 3; ++i)
          at[i] = static_cast<double>(middle[i]) + normal[i] * static_cast<double>(height) +
                  directions[2 * side][i] * static_cast<double>(part.disc.radius) * kCornerFactor;
        put_vertex(at, kind_of(part));
      }
  }

  void put_faces(const TreePart& part) {
    if (kind_of(part) == BoundKind::kBox) {
      for (const auto& corners : kBoxFaceCorners) put_face(corners, part);
      next_vertex_ += kBoxCorners;
      return;
    }
    std::array<std::uint32_t, kSides> lower{}, upper{};
    for (std::uint32_t side = 0; side < kSides; ++side) {
      lower[side] = kSides - 1 - side;  // seen from below
      upper[side] = kSides + side;
    }
    put_face(lower, part);
    put_face(upper, part);
    next_vertex_ += 2 * kSides;
  }

 private:
  void put_vertex(const std::array<double, 3>& relative, BoundKind kind) {
    for (std::size_t i = 0; i < 3; ++i) stream_.put(scale_.out(relative[i] + centre_[i]));
    stream_.put(kKindColours[static_cast<std::size_t>(kind)]);
  }

  template <class Corners>
  void put_face(const Corners& corners, const TreePart& part) {
    stream_.put(static_cast<std::uint8_t>(std::size(corners)));
    for (const std::uint32_t corner : corners) stream_.put(next_vertex_ + corner);
    stream_.put(static_cast<std::uint8_t>(part.depth));
    stream_.put(kind_of(part));
    stream_.put(part.page);
  }

  const query::Scale scale_;
  const std::array<double, 3> centre_;
  PlyStream& stream_;
  std::uint32_t next_vertex_ = 0;
};

/// Calls `take` for the parts that an export of a level has.
template <class Take>
Result<void> for_each_part(FileParts& parts, std::uint32_t level,
                           const std::function<void(std::uint32_t)>& progress, const Take& take) {
  const auto visit = [&](const TreePart& part) {
    if (part.depth < level && !part.is_block) return true;
    take(part);
    return false;
  };
  return descend_tree(parts, visit, progress);
}

void count(const TreePart& part, BoundsExport& found) {
  const BoundKind kind = kind_of(part);
  ++(kind == BoundKind::kBox         ? found.boxes
     : kind == BoundKind::kBlockDisc ? found.block_discs
                                     : found.node_discs);
  found.vertices += kind == BoundKind::kBox ? kBoxCorners : 2 * kSides;
  found.faces += kind == BoundKind::kBox ? kBoxFaces : 2;
}

}  // namespace

Result<BoundsExport> export_bounds(FileParts& parts, std::uint32_t level, OutputFile& output,
                                   const std::function<void(std::uint32_t page)>& progress) {
  BoundsExport found;
  const auto counted =
      for_each_part(parts, level, progress, [&found](const TreePart& part) { count(part, found); });
  if (!counted) return counted.error();
  if (found.vertices > std::numeric_limits<std::uint32_t>::max())
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "the level has more vertices than a PLY can number; give a lower level");
  PlyStream stream(output);
  BoundsWriter writer(parts.header()->model, stream);
  writer.put_header(found, level);
  const auto vertices = for_each_part(parts, level, progress,
                                      [&](const TreePart& part) { writer.put_vertices(part); });
  if (!vertices) return vertices.error();
  const auto faces =
      for_each_part(parts, level, progress, [&](const TreePart& part) { writer.put_faces(part); });
  if (!faces) return faces.error();
  found.written = stream.finish();
  found.bytes = output.bytes_written();
  if (found.written) found.written = output.commit();
  return found;
}

}  // namespace planetree::tools
