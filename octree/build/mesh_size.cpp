#include "octree/build/mesh_size.h"

#include <algorithm>
#include <string_view>
#include <unordered_set>

#include "octree/build/mesh_file.h"
#include "octree/build/mesh_format.h"
#include "octree/build/mesh_text.h"
#include "octree/build/off_reader.h"
#include "octree/build/ply_header.h"

namespace planetree::octree {
namespace {

constexpr std::uint64_t kMappedBytes = std::uint64_t{4} << 20;

// What the body of a PLY has beside the items of its lists, or of an ascii one at least;
// nothing if no file could have it.
std::uint64_t least_body_bytes(const PlyHeader& header) {
  std::uint64_t sum = 0;
  for (const PlyElement& element : header.elements) {
    const bool is_ascii = header.encoding == PlyEncoding::kAscii;
    const std::uint64_t record =
        is_ascii ? 2 * element.properties.size() : element.min_record_bytes();
    std::uint64_t bytes = 0;
    if (__builtin_mul_overflow(element.count, record, &bytes) ||
        __builtin_add_overflow(sum, bytes, &sum))
      return ~std::uint64_t{0};
  }
  return sum;
}

MeshSize size_of_records(std::string_view file, const Result<PlyHeader>& header) {
  if (!header) return {};
  const std::uint64_t faces = header->faces().count, vertices = header->vertices().count;
  const std::uint64_t body = file.size() - header->body.offset, least = least_body_bytes(*header);
  if (least > body) return {};
  MeshSize size{faces, vertices, !header->float32()};
  if (header->encoding == PlyEncoding::kAscii) {
    // A closed surface has twice as many triangles as vertices, whatever polygons they are in.
    size.triangles = std::max(faces, 2 * std::min(faces, vertices));
  } else {
    const PlyProperty& list = header->faces().properties[header->index_list];
    const std::uint64_t corners = (body - least) / size_bytes(list.type);
    size.triangles = corners - std::min(corners, 2 * faces);
  }
  return size;
}

/// Some windows of a file, evenly spaced.
class Sample {
 public:
  explicit Sample(std::string_view file) : file_(file) {}

  /// Calls look(window, where it begins) for each.
  template <class Look>
  void each_window(const Look& look) const {
    const std::uint64_t step = std::max<std::uint64_t>(file_.size() / kWindows, kWindowBytes);
    for (std::uint64_t at = 0; at < file_.size(); at += step)
      look(file_.substr(at, kWindowBytes), at);
  }

  /// Of a text: what count_in(line) says of all lines together, and a little more.
  template <class CountIn>
  std::uint64_t total(const CountIn& count_in) const {
    std::uint64_t count = 0, seen = 0;
    each_window([&](std::string_view window, std::uint64_t) {
      // Two lines are cut off at the ends of a window: too few to matter.
      LineScanner lines(window);
      while (lines.next()) count += count_in(lines.line());
      seen += window.size();
    });
    if (seen == 0) return 0;
    const double share = static_cast<double>(file_.size()) / static_cast<double>(seen);
    return static_cast<std::uint64_t>(static_cast<double>(count) * share * kMargin);
  }

 private:
  static constexpr std::uint64_t kWindows = 64;
  static constexpr std::uint64_t kWindowBytes = 16384;
  static constexpr double kMargin = 1 + 1.0 / 32;

  const std::string_view file_;
};

/// How many vertices an STL has, which does not say: judged by corners that are near in the
/// file, as they are written.
class StlCorners {
 public:
  void add(std::string_view corner) {
    ++count_;
    distinct_.insert(corner);
  }

  /// A surface repeats corners, of which it has half as many as triangles; a heap of triangles
  /// does not.
  std::uint64_t vertices_of(std::uint64_t triangles) const {
    const bool is_heap = distinct_.size() > count_ - count_ / 50;
    return is_heap ? 3 * triangles : triangles / 2;
  }

 private:
  std::uint64_t count_ = 0;
  std::unordered_set<std::string_view> distinct_;
};

MeshSize size_of_obj(std::string_view file) {
  const Sample sample(file);
  const std::uint64_t triangles = sample.total([](std::string_view line) -> std::uint64_t {
    if (take_word(line) != "f") return 0;
    std::uint64_t corners = 0;
    while (!take_word(line).empty()) ++corners;
    return corners - std::min<std::uint64_t>(corners, 2);
  });
  const std::uint64_t vertices = sample.total(
      [](std::string_view line) -> std::uint64_t { return take_word(line) == "v" ? 1 : 0; });
  return {triangles, vertices, true};
}

MeshSize size_of_binary_stl(std::string_view file) {
  constexpr std::uint64_t kHeadBytes = 84, kFacetBytes = 50, kNormalBytes = 12, kCornerBytes = 12;
  const std::string_view facets = file.substr(std::min<std::uint64_t>(file.size(), kHeadBytes));
  const std::uint64_t triangles = facets.size() / kFacetBytes;
  StlCorners corners;
  Sample(facets).each_window([&](std::string_view window, std::uint64_t at) {
    for (std::uint64_t facet = (kFacetBytes - at % kFacetBytes) % kFacetBytes;
         facet + kFacetBytes <= window.size(); facet += kFacetBytes)
      for (std::uint64_t k = 0; k < 3; ++k)
        corners.add(window.substr(facet + kNormalBytes + k * kCornerBytes, kCornerBytes));
  });
  return {triangles, corners.vertices_of(triangles), false};
}

MeshSize size_of_ascii_stl(std::string_view file) {
  StlCorners corners;
  const std::uint64_t triangles =
      Sample(file).total([&corners](std::string_view line) -> std::uint64_t {
        const std::string_view word = take_word(line);
        if (is_same_word(word, "vertex")) corners.add(line);
        return is_same_word(word, "facet") ? 1 : 0;
      });
  return {triangles, corners.vertices_of(triangles), true};
}

}  // namespace

Result<MeshSize> MeshSize::foresee(const std::filesystem::path& path) {
  const Result<MeshFile> file = MeshFile::open(path, kMappedBytes);
  if (!file) return file.error();
  const std::string_view text = file->text();
  switch (judge_format(text, path)) {
    case MeshFormat::kPly:
      return size_of_records(text, parse_ply_header(text));
    case MeshFormat::kOff:
      return size_of_records(text, parse_off_header(text));
    case MeshFormat::kStlBinary:
      return size_of_binary_stl(text);
    case MeshFormat::kStlAscii:
      return size_of_ascii_stl(text);
    case MeshFormat::kObj:
      return size_of_obj(text);
    case MeshFormat::kUnknown:
      break;
  }
  return MeshSize{};
}

}  // namespace planetree::octree
