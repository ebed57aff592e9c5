#include "octree/builder/mesh/mesh_size.h"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <variant>
#include <vector>

#include "octree/builder/mesh/gltf/gltf_reader.h"
#include "octree/builder/mesh/header_prefix.h"
#include "octree/builder/mesh/mesh_arrays.h"
#include "octree/builder/mesh/mesh_format.h"
#include "octree/builder/mesh/off_reader.h"
#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/triangle_stream.h"

namespace planetree::octree {
namespace {

// Minimum length of the body of a PLY. For a binary body it is the length without the items of
// lists. If the counts overflow it is more than any file has.
std::uint64_t min_body_bytes(const PlyHeader& header) {
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

Result<MeshSize> size_of_records(const MeshFile& file, const Result<PlyHeader>& header) {
  if (!header && header.error().code != ErrorCode::kBadInput) return header.error();
  if (!header) return MeshSize{};
  const std::uint64_t faces = header->faces().count, vertices = header->vertices().count;
  const std::uint64_t body = file.size_bytes() - header->body.offset,
                      least = min_body_bytes(*header);
  if (least > body) return MeshSize{};
  MeshSize size{faces, vertices, !header->float32()};
  const bool is_ascii = header->encoding == PlyEncoding::kAscii;
  size.is_indexed_text = is_ascii || header->vertices().has_list();
  if (is_ascii) {
    // A closed surface has twice as many triangles as vertices, also where its faces are polygons
    // or strips.
    const std::uint64_t of_surface = 2 * vertices;
    size.triangles =
        header->has_strips ? of_surface : std::max(faces, std::min(2 * faces, of_surface));
  } else {
    const PlyProperty& list = header->faces().properties[header->index_list];
    const std::uint64_t corners = (body - least) / size_bytes(list.type);
    size.triangles = corners - std::min(corners, 2 * faces);
  }
  return size;
}

/// Evenly spaced windows of a file.
class Sample {
 public:
  /// Reads windows of what follows the first bytes.
  static Result<Sample> of(const MeshFile& file, std::uint64_t first_bytes = 0) {
    Sample sample(file.size_bytes() - std::min(file.size_bytes(), first_bytes));
    const std::uint64_t step = std::max<std::uint64_t>(sample.size_ / kWindows, kWindowBytes);
    for (std::uint64_t at = 0; at < sample.size_; at += step) {
      Window window{at, std::string(std::min(kWindowBytes, sample.size_ - at), '\0')};
      const auto bytes = std::as_writable_bytes(std::span(window.text));
      if (const auto read = file.read(first_bytes + at, bytes); !read) return read.error();
      sample.windows_.push_back(std::move(window));
    }
    return sample;
  }

  [[nodiscard]] std::uint64_t size() const { return size_; }

  /// Calls look(window, offset of the window) for each window. The text lives as long as this.
  template <class Look>
  void each_window(const Look& look) const {
    for (const Window& window : windows_) look(std::string_view(window.text), window.at);
  }

  /// For a text: estimates the sum of count_in(line) over all lines, and adds a small margin.
  template <class CountIn>
  std::uint64_t total(const CountIn& count_in) const {
    std::uint64_t count = 0, seen = 0;
    each_window([&](std::string_view window, std::uint64_t) {
      // A window cuts lines at its two ends: too few to matter.
      LineScanner lines(window);
      while (lines.next()) count += count_in(lines.line());
      seen += window.size();
    });
    if (seen == 0) return 0;
    const double share = static_cast<double>(size_) / static_cast<double>(seen);
    return static_cast<std::uint64_t>(static_cast<double>(count) * share * kMargin);
  }

 private:
  static constexpr std::uint64_t kWindows = 64;
  static constexpr std::uint64_t kWindowBytes = 16384;
  static constexpr double kMargin = 1 + 1.0 / 32;

  struct Window {
    std::uint64_t at = 0;
    std::string text;
  };

  explicit Sample(std::uint64_t size) : size_(size) {}

  std::uint64_t size_;
  std::vector<Window> windows_;
};

/// Estimates the number of vertices of an STL, which does not state it. Counts how many of the
/// corners that are close together in the file are distinct, compared as they are written.
class StlCorners {
 public:
  void add(std::string_view corner) {
    ++count_;
    distinct_.insert(corner);
  }

  /// A surface repeats corners and has half as many vertices as triangles. A triangle soup does not
  /// repeat corners.
  std::uint64_t vertices_of(std::uint64_t triangles) const {
    const bool is_soup = distinct_.size() > count_ - count_ / 50;
    return is_soup ? 3 * triangles : triangles / 2;
  }

 private:
  std::uint64_t count_ = 0;
  std::unordered_set<std::string_view> distinct_;
};

MeshSize size_of_obj(const Sample& sample) {
  const std::uint64_t triangles = sample.total([](std::string_view line) -> std::uint64_t {
    if (take_word(line) != "f") return 0;
    std::uint64_t corners = 0;
    while (!take_word(line).empty()) ++corners;
    return corners - std::min<std::uint64_t>(corners, 2);
  });
  const std::uint64_t vertices = sample.total(
      [](std::string_view line) -> std::uint64_t { return take_word(line) == "v" ? 1 : 0; });
  return {triangles, vertices, true, true};
}

constexpr std::uint64_t kStlHeadBytes = 84;

MeshSize size_of_binary_stl(const Sample& facets) {
  constexpr std::uint64_t kFacetBytes = 50, kNormalBytes = 12, kCornerBytes = 12;
  const std::uint64_t triangles = facets.size() / kFacetBytes;
  StlCorners corners;
  facets.each_window([&](std::string_view window, std::uint64_t at) {
    for (std::uint64_t facet = (kFacetBytes - at % kFacetBytes) % kFacetBytes;
         facet + kFacetBytes <= window.size(); facet += kFacetBytes)
      for (std::uint64_t k = 0; k < 3; ++k)
        corners.add(window.substr(facet + kNormalBytes + k * kCornerBytes, kCornerBytes));
  });
  return {triangles, corners.vertices_of(triangles), false};
}

MeshSize size_of_ascii_stl(const Sample& sample) {
  StlCorners corners;
  const std::uint64_t triangles = sample.total([&corners](std::string_view line) -> std::uint64_t {
    const std::string_view word = take_word(line);
    if (is_same_word(word, "vertex")) corners.add(line);
    return is_same_word(word, "facet") ? 1 : 0;
  });
  return {triangles, corners.vertices_of(triangles), true};
}

Result<MeshSize> size_of_scene(const MeshFile& file) {
  const Result<GltfSize> declared = size_of_gltf(file);
  if (!declared && declared.error().code != ErrorCode::kBadInput) return declared.error();
  if (!declared) return MeshSize{};
  MeshSize size{declared->triangles, declared->vertices, declared->float64};
  size.unpacked_bytes = declared->embedded_bytes;
  return size;
}

template <class SizeOf>
Result<MeshSize> size_by(const SizeOf& size_of, const Result<Sample>& sample) {
  if (!sample) return sample.error();
  return size_of(*sample);
}

Result<PlyHeader> ply_header_of(const MeshFile& file, const MeshOptions& options) {
  Result<PlyHeader> header = parse_prefix(file, parse_ply_header);
  if (header && options.float64) header->widen_text();
  return header;
}

Result<MeshSize> size_of_file(const std::filesystem::path& path, storage::FileCalls& calls,
                              const MeshOptions& options) {
  const Result<MeshFile> file = MeshFile::open(path, calls);
  if (!file) return file.error();
  const Result<Packing> packing = detect_packing(*file);
  if (!packing) return packing.error();
  if (*packing == Packing::kNone) return MeshSize::estimate(*file, path, options);
  const Result<std::uint64_t> stated = stated_bytes(*file, *packing);
  if (!stated) return stated.error();
  MeshSize size;
  size.unpacked_bytes = std::max(*stated, file->size_bytes());
  return size;
}

struct SizeOf {
  Result<MeshSize> operator()(const std::filesystem::path& path) const {
    return size_of_file(path, calls, options);
  }
  Result<MeshSize> operator()(const BuildInput::Files& files) const {
    MeshSize sum;
    for (const std::filesystem::path& path : files.paths) {
      const Result<MeshSize> size = size_of_file(path, calls, options);
      if (!size && failed_at != nullptr) *failed_at = path;
      if (!size) return size;
      sum.add(*size);
    }
    return sum;
  }
  Result<MeshSize> operator()(const BuildInput::Stream& stream) const {
    return size_of_stream(stream);
  }
  template <class Vertex>
  Result<MeshSize> operator()(const BuildInput::Mesh<Vertex>& mesh) const {
    return size_of_arrays(mesh);
  }
  storage::FileCalls& calls;
  const MeshOptions& options;
  std::filesystem::path* failed_at;
};

}  // namespace

void MeshSize::add(const MeshSize& next) {
  triangles += next.triangles;
  vertices += next.vertices;
  float64 = float64 || next.float64;
  is_indexed_text = is_indexed_text || next.is_indexed_text;
  unpacked_bytes = std::max(unpacked_bytes, next.unpacked_bytes);
}

Result<MeshSize> MeshSize::estimate(const MeshFile& file, const std::filesystem::path& path,
                                    const MeshOptions& options) {
  const Result<MeshFormat> format = detect_format(file, path);
  if (!format) return format.error();
  switch (*format) {
    case MeshFormat::kPly:
      return size_of_records(file, ply_header_of(file, options));
    case MeshFormat::kOff:
      return size_of_records(file, parse_prefix(file, parse_off_header));
    case MeshFormat::kStlBinary:
      return size_by(size_of_binary_stl, Sample::of(file, kStlHeadBytes));
    case MeshFormat::kStlAscii:
      return size_by(size_of_ascii_stl, Sample::of(file));
    case MeshFormat::kObj:
      return size_by(size_of_obj, Sample::of(file));
    case MeshFormat::kGltf:
      return size_of_scene(file);
    case MeshFormat::kUnknown:
      break;
  }
  return MeshSize{};
}

Result<MeshSize> MeshSize::estimate(const BuildInput& input, storage::FileCalls& calls,
                                    const MeshOptions& options, std::filesystem::path* failed_at) {
  return std::visit(SizeOf{calls, options, failed_at}, input.content());
}

}  // namespace planetree::octree
