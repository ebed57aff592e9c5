#include "tools/shapes/generate_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace planetree::tools {
namespace {

static_assert(std::endian::native == std::endian::little,
              "records are written as they lie in memory: little-endian machines only");

constexpr std::size_t kVertexBytes = 3 * sizeof(float);
constexpr std::size_t kTriangleBytes = 1 + 3 * sizeof(std::uint32_t);
/// Records per write. Large enough to make system calls and progress cheap.
constexpr std::uint64_t kRecordsPerPiece = 16384;

std::string ply_header(const Shape& shape, std::string_view comment) {
  assert(comment.find('\n') == std::string_view::npos);
  const bool fits_int = shape.vertex_count() <= Shape::kMaxVertices / 2;
  return fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment {}\n"
      "element vertex {}\n"
      "property float x\n"
      "property float y\n"
      "property float z\n"
      "element face {}\n"
      "property list uchar {} vertex_indices\n"
      "end_header\n",
      comment, shape.vertex_count(), shape.triangle_count(), fits_int ? "int" : "uint");
}

void encode_vertex(const Vec3& position, std::byte* record) {
  const std::array<float, 3> rounded = {static_cast<float>(position.x),
                                        static_cast<float>(position.y),
                                        static_cast<float>(position.z)};
  std::memcpy(record, rounded.data(), kVertexBytes);
}

void encode_triangle(const std::array<std::uint64_t, 3>& corners, std::byte* record) {
  const std::array<std::uint32_t, 3> indices = {static_cast<std::uint32_t>(corners[0]),
                                                static_cast<std::uint32_t>(corners[1]),
                                                static_cast<std::uint32_t>(corners[2])};
  record[0] = std::byte{3};
  std::memcpy(record + 1, indices.data(), kTriangleBytes - 1);
}

/// Writes `count` records of `record_bytes`. encode(index, record) fills each.
template <class Encode>
Result<void> write_records(std::uint64_t count, std::size_t record_bytes, OutputFile& file,
                           Progress& progress, Encode encode) {
  std::vector<std::byte> piece(kRecordsPerPiece * record_bytes);
  for (std::uint64_t start = 0; start < count; start += kRecordsPerPiece) {
    const std::uint64_t records = std::min(kRecordsPerPiece, count - start);
    for (std::uint64_t i = 0; i < records; ++i) encode(start + i, &piece[i * record_bytes]);
    const auto written = file.write(std::span(piece).first(records * record_bytes));
    if (!written) return written;
    progress.add(records);
  }
  return {};
}

}  // namespace

std::uint64_t ply_bytes(const Shape& shape, std::string_view comment) {
  return ply_header(shape, comment).size() + shape.vertex_count() * kVertexBytes +
         shape.triangle_count() * kTriangleBytes;
}

Result<void> write_ply(const Shape& shape, std::string_view comment, OutputFile& file,
                       Progress& progress) {
  const std::string header = ply_header(shape, comment);
  if (const auto written = file.write(std::as_bytes(std::span(header))); !written) return written;

  progress.start("writing vertices", shape.vertex_count(), "vertices");
  const auto vertices = write_records(
      shape.vertex_count(), kVertexBytes, file, progress,
      [&](std::uint64_t i, std::byte* record) { encode_vertex(shape.vertex(i), record); });
  if (!vertices) return vertices;

  progress.start("writing triangles", shape.triangle_count(), "triangles");
  const auto triangles = write_records(
      shape.triangle_count(), kTriangleBytes, file, progress,
      [&](std::uint64_t i, std::byte* record) { encode_triangle(shape.triangle(i), record); });
  progress.finish();
  return triangles;
}

}  // namespace planetree::tools
