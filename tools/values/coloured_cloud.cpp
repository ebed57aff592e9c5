#include "tools/values/coloured_cloud.h"

#include <limits>
#include <utility>

#include "tools/cli/input_file.h"

namespace planetree::tools {

ColouredCloud::ColouredCloud(OutputFile output, const std::filesystem::path& path,
                             const std::filesystem::path& directory, std::string property,
                             std::string comment)
    : output_(std::move(output)),
      extension_(lower_extension(path)),
      directory_(directory),
      property_(std::move(property)),
      comment_(std::move(comment)),
      points_(directory),
      triangles_(directory) {}

Result<std::unique_ptr<ColouredCloud>> ColouredCloud::create(const std::filesystem::path& path,
                                                             std::string property,
                                                             std::string comment,
                                                             bool may_replace) {
  auto output = OutputFile::create(path, may_replace);
  if (!output) return output.error();
  const std::filesystem::path folder = path.parent_path();
  return std::unique_ptr<ColouredCloud>(new ColouredCloud(*std::move(output), path,
                                                          folder.empty() ? "." : folder,
                                                          std::move(property), std::move(comment)));
}

Result<void> ColouredCloud::add(const Vec3& point, double value) {
  return points_.add({point.x, point.y, point.z, value});
}

Result<void> ColouredCloud::add_triangle(const std::array<std::uint64_t, 3>& points) {
  TriangleRecord record{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (points[i] > std::numeric_limits<std::uint32_t>::max())
      return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                        "a PLY cannot have this many points; omit --output");
    record[i] = static_cast<std::uint32_t>(points[i]);
  }
  return triangles_.add(record);
}

Result<void> ColouredCloud::commit(const ColourScale& colours) {
  const auto written = extension_ == ".vtp"   ? write_vtp(colours)
                       : extension_ == ".npy" ? write_npy(colours)
                                              : write_ply(colours);
  return written ? output_.commit() : written;
}

}  // namespace planetree::tools
