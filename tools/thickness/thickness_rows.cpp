#include "tools/thickness/thickness_rows.h"

#include <fmt/format.h>

#include <iterator>

namespace planetree::tools {

std::string thickness_rows(std::span<const Vec3> points, std::span<const WallThickness> walls) {
  std::string text;
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& point = points[i];
    const WallThickness& wall = walls[i];
    fmt::format_to(out, "{},{},{},{},{},{},", point.x, point.y, point.z, wall.thickness, wall.lower,
                   wall.upper);
    if (wall.has_contact)
      fmt::format_to(out, "{},{},{},", wall.contact.x, wall.contact.y, wall.contact.z);
    else
      fmt::format_to(out, ",,,");
    fmt::format_to(out, "{}\n", name_of(wall.status));
  }
  return text;
}

}  // namespace planetree::tools
