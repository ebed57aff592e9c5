#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "tests/octree/support/sample_mask.h"

/// Files of parts of a mesh. Each triangle has three vertices of its own, as in an STL, so that the
/// files of all formats list the same vertices.
namespace planetree::octree {

/// A mesh whose coordinates are short numbers, which each format has exactly.
inline Soup with_short_numbers(Soup soup) {
  for (auto& triangle : soup)
    for (Vec3& corner : triangle)
      for (double* const value : {&corner.x, &corner.y, &corner.z})
        *value = std::round(*value * 1024) / 1024;
  return soup;
}

/// Divides a mesh before each of the triangles `cuts`, which ascend.
inline std::vector<Soup> split(const Soup& soup, const std::vector<std::size_t>& cuts) {
  std::vector<Soup> parts;
  std::size_t from = 0;
  for (std::size_t i = 0; i <= cuts.size(); ++i) {
    const std::size_t to = i < cuts.size() ? cuts[i] : soup.size();
    parts.emplace_back(soup.begin() + static_cast<std::ptrdiff_t>(from),
                       soup.begin() + static_cast<std::ptrdiff_t>(to));
    from = to;
  }
  return parts;
}

/// Writes an OBJ; `rest` follows the faces.
inline void write_obj(const Soup& soup, const std::filesystem::path& path,
                      const std::string& rest = "") {
  std::ofstream file(path);
  file.precision(std::numeric_limits<double>::max_digits10);
  for (const auto& triangle : soup)
    for (const Vec3& corner : triangle)
      file << "v " << corner.x << ' ' << corner.y << ' ' << corner.z << '\n';
  for (std::size_t i = 0; i < soup.size(); ++i)
    file << "f " << 3 * i + 1 << ' ' << 3 * i + 2 << ' ' << 3 * i + 3 << '\n';
  file << rest;
}

/// Writes an ascii PLY with colours of the vertices and values of the faces, which depend on the
/// triangle's index in the whole mesh.
///
/// first  index of the first triangle.
/// value  type of the values.
inline void write_ply(const Soup& soup, const std::filesystem::path& path, std::size_t first = 0,
                      const std::string& value = "int", const std::string& real = "float") {
  std::ofstream file(path);
  file.precision(std::numeric_limits<double>::max_digits10);
  file << "ply\nformat ascii 1.0\nelement vertex " << 3 * soup.size();
  for (const char* const name : {"x", "y", "z"}) file << "\nproperty " << real << ' ' << name;
  for (const char* const name : {"red", "green", "blue"}) file << "\nproperty uchar " << name;
  file << "\nelement face " << soup.size() << "\nproperty list uchar int vertex_indices\nproperty "
       << value << " value\nend_header\n";
  std::size_t number = 3 * first;
  for (const auto& triangle : soup)
    for (const Vec3& corner : triangle) {
      file << corner.x << ' ' << corner.y << ' ' << corner.z << ' ' << number % 251 << ' '
           << number % 7 << " 9\n";
      ++number;
    }
  for (std::size_t i = 0; i < soup.size(); ++i)
    file << "3 " << 3 * i << ' ' << 3 * i + 1 << ' ' << 3 * i + 2 << ' ' << (first + i) * 17
         << '\n';
}

}  // namespace planetree::octree
