#include "tools/answers/point_cloud.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cerrno>
#include <vector>

#include "storage/system/file_error.h"

namespace planetree::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "vertices are written in place");

Error spool_error() {
  return storage::file_error(errno, storage::FileAction::kWrite,
                             "write the points to a temporary file");
}

}  // namespace

Result<PointCloud> PointCloud::create(const std::string& value, bool has_normals) {
  std::FILE* const file = std::tmpfile();
  if (file == nullptr) return spool_error();
  return PointCloud(file, value, has_normals);
}

Result<void> PointCloud::add(const Vec3& point, const Vec3& normal, double value) {
  const std::array<double, 7> numbers = {point.x,  point.y,  point.z, value,
                                         normal.x, normal.y, normal.z};
  const std::size_t count = has_normals_ ? 7 : 4;
  if (std::fwrite(numbers.data(), sizeof(double), count, file_.get()) != count)
    return spool_error();
  ++count_;
  return {};
}

Result<bool> PointCloud::write_to(AnswerOutput& output) {
  std::string header =
      fmt::format("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", count_);
  for (const std::string& name : {std::string("x"), std::string("y"), std::string("z"), value_})
    header += "property double " + name + '\n';
  for (const char* name : {"nx", "ny", "nz"})
    if (has_normals_) header += std::string("property double ") + name + '\n';
  auto written = output.write(header + "end_header\n");
  if (std::fflush(file_.get()) != 0) return spool_error();
  std::rewind(file_.get());
  std::vector<char> piece(std::size_t{1} << 18);
  while (written && *written) {
    const std::size_t bytes = std::fread(piece.data(), 1, piece.size(), file_.get());
    if (bytes == 0) break;
    written = output.write({piece.data(), bytes});
  }
  if (std::ferror(file_.get()) != 0) return spool_error();
  return written;
}

}  // namespace planetree::tools
