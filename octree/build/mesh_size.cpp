#include "octree/build/mesh_size.h"

#include <algorithm>
#include <string_view>

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

/// Counts in the lines of some windows of a text, evenly spaced, for the whole of it.
class TextSample {
 public:
  explicit TextSample(std::string_view text) : text_(text) {}

  /// What count_in(line) says of all lines together, and a little more.
  template <class CountIn>
  std::uint64_t total(const CountIn& count_in) const {
    const std::uint64_t step = std::max<std::uint64_t>(text_.size() / kWindows, kWindowBytes);
    std::uint64_t count = 0, seen = 0;
    for (std::uint64_t at = 0; at < text_.size(); at += step) {
      // Two lines are cut off at the ends of a window: too few to matter.
      std::string_view window = text_.substr(at, kWindowBytes);
      seen += window.size();
      LineScanner lines(window);
      while (lines.next()) count += count_in(lines.line());
    }
    if (seen == 0) return 0;
    const double share = static_cast<double>(text_.size()) / static_cast<double>(seen);
    return static_cast<std::uint64_t>(static_cast<double>(count) * share * kMargin);
  }

 private:
  static constexpr std::uint64_t kWindows = 64;
  static constexpr std::uint64_t kWindowBytes = 16384;
  static constexpr double kMargin = 1 + 1.0 / 32;

  const std::string_view text_;
};

MeshSize size_of_obj(std::string_view file) {
  const TextSample sample(file);
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

MeshSize size_of_binary_stl(std::uint64_t bytes) {
  constexpr std::uint64_t kHeadBytes = 84, kFacetBytes = 50;
  const std::uint64_t triangles = (bytes - std::min(bytes, kHeadBytes)) / kFacetBytes;
  return {triangles, triangles / 2, false};
}

MeshSize size_of_ascii_stl(std::string_view file) {
  const std::uint64_t triangles =
      TextSample(file).total([](std::string_view line) -> std::uint64_t {
        return is_same_word(take_word(line), "facet") ? 1 : 0;
      });
  return {triangles, triangles / 2, true};
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
      return size_of_binary_stl(text.size());
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
