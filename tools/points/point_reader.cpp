#include "tools/points/point_reader.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>

#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "tools/cli/input_file.h"
#include "tools/points/csv_points.h"
#include "tools/points/ply_points.h"
#include "tools/points/raw_points.h"

namespace planetree::tools {
namespace {

// Enough to recognise a PLY file.
constexpr std::uint64_t kPlyBytes = 4;

bool is_regular(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

bool has_extension(const std::string& path, std::string_view extension) {
  std::string found = std::filesystem::path(path).extension().string();
  std::transform(found.begin(), found.end(), found.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; });
  return found == extension;
}

}  // namespace

std::string points_name(const std::string& path) { return path == "-" ? "standard input" : path; }

Result<std::unique_ptr<PointReader>> open_points(const std::string& path,
                                                 std::FILE* standard_input) {
  const auto csv = [&path](InputFile file) -> std::unique_ptr<PointReader> {
    return std::make_unique<CsvPoints>(points_name(path), std::move(file));
  };
  if (path == "-") return csv(InputFile::borrow(standard_input));
  const bool raw = has_extension(path, ".f64");
  // A pipe can be read only once and in order, so that it may hold CSV or raw numbers only.
  if (!raw && is_regular(path)) {
    auto file = octree::MeshFile::open(path);
    if (!file) return file.error();
    const auto front = file->prefix(kPlyBytes);
    if (!front) return front.error();
    if (octree::is_ply(*front)) return PlyPoints::create(path, *std::move(file));
  }
  auto file = InputFile::open(path);
  if (!file) return file.error();
  if (raw) return std::unique_ptr<PointReader>(std::make_unique<RawPoints>(path, *std::move(file)));
  return csv(*std::move(file));
}

}  // namespace planetree::tools
