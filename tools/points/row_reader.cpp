#include "tools/points/row_reader.h"

#include <sys/stat.h>

#include <optional>
#include <type_traits>
#include <vector>

#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "tools/cli/input_file.h"
#include "tools/points/foreign_format.h"
#include "tools/points/las_points.h"
#include "tools/points/npy_rows.h"
#include "tools/points/ply_points.h"
#include "tools/points/raw_rows.h"
#include "tools/points/spooled_file.h"
#include "tools/points/text_rows.h"

namespace planetree::tools {
namespace {

// Enough to recognise a format and the layout of a text.
constexpr std::size_t kFrontBytes = std::size_t{1} << 18;

std::optional<std::uint64_t> regular_size(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return static_cast<std::uint64_t>(status.st_size);
}

Error no_columns() {
  return make_error(
      ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
      "--columns is for text; the columns of PLY, LAS, .npy and .f64 are known, so omit it");
}

/// A PLY is read at several offsets, which a pipe does not allow.
Result<std::unique_ptr<PointReader>> open_ply(const std::string& path, InputFile file) {
  auto ply = regular_size(path) ? octree::MeshFile::open(path) : spool(file);
  if (!ply) return ply.error();
  return PlyPoints::create(points_name(path), *std::move(ply));
}

/// PLY and LAS have points alone.
Error points_alone(const char* format, const RowShape& shape) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "this is %s, which has no %ss; give them as CSV, .npy or .f64", format,
                    shape.noun);
}

template <class Row>
Result<std::unique_ptr<RowReader<Row>>> open_rows(const std::string& path,
                                                  std::FILE* standard_input, const RowShape& shape,
                                                  const ColumnChoice& choice) {
  using Reader = std::unique_ptr<RowReader<Row>>;
  auto file = path == "-" ? InputFile::borrow(standard_input) : InputFile::open(path);
  if (!file) return file.error();
  if (is_raw_rows(path)) {
    if (!choice.empty()) return no_columns();
    return Reader(std::make_unique<RawRows<Row>>(path, *std::move(file), shape));
  }
  const auto front = file->front(kFrontBytes);
  if (!front) return front.error();
  if (octree::is_ply(*front)) {
    if constexpr (std::is_same_v<Row, Vec3>) {
      if (!choice.empty()) return no_columns();
      return open_ply(path, *std::move(file));
    } else {
      return points_alone("PLY", shape);
    }
  }
  if (is_las(*front)) {
    if constexpr (std::is_same_v<Row, Vec3>) {
      if (!choice.empty()) return no_columns();
      return LasPoints::create(points_name(path), *std::move(file), *front);
    } else {
      return points_alone("LAS", shape);
    }
  }
  if (is_npy(*front)) {
    if (!choice.empty()) return no_columns();
    const Result<NpyHeader> header = parse_npy_header(*front, shape);
    if (!header) return header.error();
    std::vector<std::byte> skipped(header->bytes);
    if (const auto read = file->read(skipped); !read) return read.error();
    return Reader(std::make_unique<NpyRows<Row>>(points_name(path), *std::move(file), *header));
  }
  const bool is_whole = front->size() < kFrontBytes;
  const auto size = is_whole ? std::optional<std::uint64_t>(front->size()) : regular_size(path);
  if (auto error = find_foreign_format(*front, size, shape)) return *error;
  auto lines = TextLines::create(*std::move(file), *front, is_whole, shape, choice);
  if (!lines) return lines.error();
  return Reader(std::make_unique<TextRows<Row>>(points_name(path), *std::move(lines)));
}

}  // namespace

bool is_raw_rows(const std::filesystem::path& path) { return lower_extension(path) == ".f64"; }

std::string points_name(const std::string& path) { return path == "-" ? "standard input" : path; }

Result<std::unique_ptr<PointReader>> open_points(const std::string& path, std::FILE* standard_input,
                                                 const ColumnChoice& choice) {
  return open_rows<Vec3>(path, standard_input, kPointShape, choice);
}

Result<std::unique_ptr<RayReader>> open_rays(const std::string& path, std::FILE* standard_input,
                                             const ColumnChoice& choice) {
  return open_rows<Ray>(path, standard_input, kRayShape, choice);
}

Result<std::unique_ptr<SweepReader>> open_sweeps(const std::string& path, std::FILE* standard_input,
                                                 const ColumnChoice& choice) {
  return open_rows<Sweep>(path, standard_input, kSweepShape, choice);
}

}  // namespace planetree::tools
