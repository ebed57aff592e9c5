#include "tools/values/coloured_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <span>
#include <utility>

namespace planetree::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "records are written in place");

constexpr std::size_t kPieceRecords = 32768;

struct PointRecord {
  double x, y, z, value;
};
using TriangleRecord = std::array<std::uint32_t, 3>;

constexpr std::size_t kPointBytes = 3 * sizeof(double) + sizeof(float) + sizeof(Colour);
constexpr std::size_t kTriangleBytes = 1 + sizeof(TriangleRecord);

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto raw = std::as_bytes(std::span(&value, 1));
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

/// Reads the records of a temporary file piece by piece. take(records) returns Result<void>.
template <class Record, class Take>
Result<void> for_each_piece(const storage::SpillFile& file, std::uint64_t count, const Take& take) {
  std::vector<Record> records;
  for (std::uint64_t first = 0; first < count; first += records.size()) {
    records.resize(std::min<std::uint64_t>(kPieceRecords, count - first));
    const auto read = file.read(first * sizeof(Record), std::as_writable_bytes(std::span(records)));
    if (!read) return read;
    if (const auto taken = take(std::span<const Record>(records)); !taken) return taken;
  }
  return {};
}

}  // namespace

Result<void> ColouredPly::Spool::add(const void* record, std::size_t bytes) {
  const auto* const raw = static_cast<const std::byte*>(record);
  piece.insert(piece.end(), raw, raw + bytes);
  ++count;
  return piece.size() >= kPieceRecords * bytes ? flush() : Result<void>();
}

Result<void> ColouredPly::Spool::flush() {
  const auto appended = file.append(piece);
  piece.clear();
  return appended ? Result<void>() : appended.error();
}

ColouredPly::ColouredPly(OutputFile output, const std::filesystem::path& directory,
                         std::string property, std::string comment)
    : output_(std::move(output)),
      property_(std::move(property)),
      comment_(std::move(comment)),
      points_(directory),
      triangles_(directory) {}

Result<std::unique_ptr<ColouredPly>> ColouredPly::create(const std::filesystem::path& path,
                                                         std::string property, std::string comment,
                                                         bool may_replace) {
  auto output = OutputFile::create(path, may_replace);
  if (!output) return output.error();
  const std::filesystem::path folder = path.parent_path();
  return std::unique_ptr<ColouredPly>(new ColouredPly(
      *std::move(output), folder.empty() ? "." : folder, std::move(property), std::move(comment)));
}

Result<void> ColouredPly::add(const Vec3& point, double value) {
  const PointRecord record{point.x, point.y, point.z, value};
  return points_.add(&record, sizeof(record));
}

Result<void> ColouredPly::add_triangle(const std::array<std::uint64_t, 3>& points) {
  TriangleRecord record{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (points[i] > std::numeric_limits<std::uint32_t>::max())
      return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                        "a PLY cannot have this many points; omit --output");
    record[i] = static_cast<std::uint32_t>(points[i]);
  }
  return triangles_.add(&record, sizeof(record));
}

Result<void> ColouredPly::write_points(const ColourScale& colours) {
  std::vector<std::byte> bytes;
  return for_each_piece<PointRecord>(points_.file, points_.count,
                                     [&](std::span<const PointRecord> records) {
                                       bytes.clear();
                                       bytes.reserve(records.size() * kPointBytes);
                                       for (const PointRecord& record : records) {
                                         append(bytes, record.x);
                                         append(bytes, record.y);
                                         append(bytes, record.z);
                                         append(bytes, static_cast<float>(record.value));
                                         append(bytes, colours.colour(record.value));
                                       }
                                       return output_.write(bytes);
                                     });
}

Result<void> ColouredPly::write_triangles() {
  std::vector<std::byte> bytes;
  return for_each_piece<TriangleRecord>(triangles_.file, triangles_.count,
                                        [&](std::span<const TriangleRecord> records) {
                                          bytes.clear();
                                          bytes.reserve(records.size() * kTriangleBytes);
                                          for (const TriangleRecord& record : records) {
                                            append(bytes, std::uint8_t{3});
                                            append(bytes, record);
                                          }
                                          return output_.write(bytes);
                                        });
}

Result<void> ColouredPly::commit(const ColourScale& colours) {
  for (Spool* const spool : {&points_, &triangles_})
    if (const auto flushed = spool->flush(); !flushed) return flushed;
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {}\ncomment colours from {} to {}\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "property float {}\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n",
      comment_, colours.lower(), colours.upper(), points_.count, property_);
  if (triangles_.count > 0)
    header +=
        fmt::format("element face {}\nproperty list uchar uint vertex_indices\n", triangles_.count);
  header += "end_header\n";
  auto written = output_.write(std::as_bytes(std::span(header)));
  if (written) written = write_points(colours);
  if (written) written = write_triangles();
  return written ? output_.commit() : written;
}

}  // namespace planetree::tools
