#include "tools/arrays/vtp_cloud.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <utility>

namespace planetree::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written in place");

constexpr std::size_t kVtpPieceBytes = std::size_t{1} << 18;
constexpr std::uint64_t kVtpHeldBytes = kVtpPieceBytes;  // of each temporary file

const char* vtk_type(NumberType type) {
  switch (type) {
    case NumberType::kFloat64:
      return "Float64";
    case NumberType::kInt64:
      return "Int64";
    case NumberType::kUint8:
    case NumberType::kBool:
      break;
  }
  return "UInt8";
}

/// The bytes of an array are behind their number, as the header of the file says.
Result<bool> write_length(const VtpCloud::Write& write, std::uint64_t bytes) {
  return write({reinterpret_cast<const char*>(&bytes), sizeof bytes});
}

/// Writes the numbers first, first + step and so on as an array.
Result<bool> write_progression(const VtpCloud::Write& write, std::uint64_t count,
                               std::uint64_t first, std::uint64_t step) {
  auto written = write_length(write, count * sizeof(std::uint64_t));
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t done = 0; done < count && written && *written; done += numbers.size()) {
    numbers.resize(std::min<std::uint64_t>(kVtpPieceBytes / sizeof(std::uint64_t), count - done));
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = first + step * (done + i);
    written = write(
        {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(std::uint64_t)});
  }
  return written;
}

}  // namespace

VtpCloud::VtpCloud(std::vector<Column> columns, std::string points, std::string scalars,
                   const std::filesystem::path& directory)
    : columns_(std::move(columns)),
      scalars_(std::move(scalars)),
      corners_(directory, kVtpHeldBytes) {
  const auto named = std::ranges::find(columns_, points, &Column::name);
  assert(named != columns_.end() && named->count() == 3);
  positions_ = static_cast<std::size_t>(named - columns_.begin());
  for (std::size_t i = 0; i < columns_.size(); ++i)
    spools_.push_back(std::make_unique<storage::SpillFile>(directory, kVtpHeldBytes));
}

Result<void> VtpCloud::add(std::span<const std::byte> rows) {
  assert(rows.size() % row_bytes(columns_) == 0);
  rows_.insert(rows_.end(), rows.begin(), rows.end());
  return rows_.size() < kVtpPieceBytes ? Result<void>() : flush_rows();
}

Result<void> VtpCloud::flush_rows() {
  const std::size_t step = row_bytes(columns_), count = rows_.size() / step;
  std::vector<std::byte> numbers;
  std::size_t at = 0;  // of the column in a row
  for (std::size_t c = 0; c < columns_.size(); at += columns_[c++].bytes()) {
    const std::size_t bytes = columns_[c].bytes();
    numbers.resize(count * bytes);
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(numbers.data() + i * bytes, rows_.data() + i * step + at, bytes);
    if (const auto appended = spools_[c]->append(numbers); !appended) return appended.error();
  }
  rows_.clear();
  return {};
}

Result<void> VtpCloud::add_triangle(const std::array<std::uint64_t, 3>& points) {
  new_corners_.insert(new_corners_.end(), points.begin(), points.end());
  return new_corners_.size() * sizeof(std::uint64_t) < kVtpPieceBytes ? Result<void>()
                                                                      : flush_triangles();
}

Result<void> VtpCloud::flush_triangles() {
  const auto appended = corners_.append(std::as_bytes(std::span(new_corners_)));
  new_corners_.clear();
  return appended ? Result<void>() : appended.error();
}

VtpCloud::Array VtpCloud::array_of(std::size_t column) const {
  const Column& described = columns_[column];
  Array array{vtk_type(described.type), column == positions_ ? "Points" : described.name, "",
              spools_[column]->size_bytes()};
  if (described.parts.empty()) return array;
  array.attributes = fmt::format(" NumberOfComponents=\"{}\"", described.count());
  for (std::size_t i = 0; i < described.count(); ++i)
    array.attributes += fmt::format(" ComponentName{}=\"{}\"", i, described.parts[i]);
  return array;
}

/// The XML in front of the arrays, which follow in the order in which it names them.
std::string VtpCloud::head() const {
  std::uint64_t offset = 0;
  const auto declare = [&offset](const Array& array) {
    const std::uint64_t begin = std::exchange(offset, offset + sizeof offset + array.bytes);
    return fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\"{} format=\"appended\" offset=\"{}\"/>\n",
        array.type, array.name, array.attributes, begin);
  };
  const std::uint64_t points = spools_[positions_]->size_bytes() / columns_[positions_].bytes();
  const std::uint64_t corners = corners_.size_bytes() / sizeof(std::uint64_t);
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n"
      "  <PolyData>\n"
      "    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"0\" "
      "NumberOfStrips=\"0\" NumberOfPolys=\"{}\">\n"
      "      <Points>\n",
      points, corners == 0 ? points : 0, corners / 3);
  text += declare(array_of(positions_));
  text += fmt::format("      </Points>\n      <PointData Scalars=\"{}\">\n", scalars_);
  for (std::size_t c = 0; c < columns_.size(); ++c)
    if (c != positions_) text += declare(array_of(c));
  const char* const cells = corners == 0 ? "Verts" : "Polys";
  const std::uint64_t cell_count = corners == 0 ? points : corners / 3;
  text += fmt::format("      </PointData>\n      <{}>\n", cells);
  text += declare(
      {"Int64", "connectivity", "", (corners == 0 ? points : corners) * sizeof(std::uint64_t)});
  text += declare({"Int64", "offsets", "", cell_count * sizeof(std::uint64_t)});
  return text + fmt::format(
                    "      </{}>\n    </Piece>\n  </PolyData>\n"
                    "  <AppendedData encoding=\"raw\">\n   _",
                    cells);
}

Result<bool> VtpCloud::write_spool(const Write& write, const storage::SpillFile& spool) const {
  auto written = write_length(write, spool.size_bytes());
  std::vector<std::byte> piece;
  for (std::uint64_t at = 0; at < spool.size_bytes() && written && *written; at += piece.size()) {
    piece.resize(std::min<std::uint64_t>(kVtpPieceBytes, spool.size_bytes() - at));
    if (const auto read = spool.read(at, piece); !read) return read.error();
    written = write({reinterpret_cast<const char*>(piece.data()), piece.size()});
  }
  return written;
}

Result<bool> VtpCloud::write_cells(const Write& write) const {
  const std::uint64_t corners = corners_.size_bytes() / sizeof(std::uint64_t);
  if (corners > 0) {
    const auto written = write_spool(write, corners_);
    return written && *written ? write_progression(write, corners / 3, 3, 3) : written;
  }
  const std::uint64_t points = spools_[positions_]->size_bytes() / columns_[positions_].bytes();
  const auto written = write_progression(write, points, 0, 1);
  return written && *written ? write_progression(write, points, 1, 1) : written;
}

Result<bool> VtpCloud::write_to(const Write& write) {
  if (const auto flushed = flush_rows(); !flushed) return flushed.error();
  if (const auto flushed = flush_triangles(); !flushed) return flushed.error();
  auto written = write(head());
  if (written && *written) written = write_spool(write, *spools_[positions_]);
  for (std::size_t c = 0; c < columns_.size() && written && *written; ++c)
    if (c != positions_) written = write_spool(write, *spools_[c]);
  if (written && *written) written = write_cells(write);
  return written && *written ? write("\n  </AppendedData>\n</VTKFile>\n") : written;
}

}  // namespace planetree::tools
