#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "planetree/types.h"

namespace planetree::tools {

/// A coloured PLY as a test reads it: written from the format's description.
struct PlyText {
  struct Point {
    Vec3 place;
    float value = 0;
    std::array<std::uint8_t, 3> colour{};
  };
  std::string header;
  std::vector<Point> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  bool is_whole = false;  ///< the file ends where its header says

  explicit PlyText(const std::string& file) {
    const std::string end = "end_header\n";
    std::size_t at = file.find(end) + end.size();
    header = file.substr(0, at);
    const auto count_of = [&](const std::string& element) -> std::size_t {
      const std::size_t found = header.find("element " + element + ' ');
      return found == std::string::npos ? 0 : std::stoul(header.substr(found + element.size() + 9));
    };
    const std::size_t point_count = count_of("vertex"), triangle_count = count_of("face");
    is_whole = file.size() == at + 31 * point_count + 13 * triangle_count;
    if (!is_whole) return;
    const auto take = [&](void* to, std::size_t bytes) {
      std::memcpy(to, file.data() + at, bytes);
      at += bytes;
    };
    points.resize(point_count);
    for (Point& point : points) {
      take(&point.place, 24);
      take(&point.value, 4);
      take(point.colour.data(), 3);
    }
    triangles.resize(triangle_count);
    for (auto& triangle : triangles) {
      ++at;
      take(triangle.data(), 12);
    }
  }
};

}  // namespace planetree::tools
