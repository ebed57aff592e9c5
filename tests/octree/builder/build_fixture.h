#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "octree/builder/tree_builder.h"
#include "tests/octree/support/sample_mask.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::octree {

/// Builds of models of many chunks, as those of large models are, with limits so small that the
/// models are small.
class SmallChunks : public testing::Test {
 protected:
  // Writes a binary STL, whose corners are floats.
  void write(const Soup& soup) const { write(soup, mesh_); }
  static void write(const Soup& soup, const std::filesystem::path& path) {
    std::ofstream file(path, std::ios::binary);
    const auto put = [&file](const auto& value) {
      file.write(reinterpret_cast<const char*>(&value), sizeof value);
    };
    file << std::string(80, ' ');
    put(static_cast<std::uint32_t>(soup.size()));
    for (const auto& triangle : soup) {
      for (int i = 0; i < 3; ++i) put(0.0f);
      for (const Vec3& corner : triangle)
        for (const double value : {corner.x, corner.y, corner.z}) put(static_cast<float>(value));
      put(std::uint16_t{0});
    }
  }
  // Writes a binary PLY with float64 properties, vertices and faces in random order. The file's
  // extension stays .stl; readers go by the content.
  void write_in_random_order(Soup soup) {
    std::mt19937 random(4);
    std::shuffle(soup.begin(), soup.end(), random);
    std::vector<Vec3> vertices;
    for (const auto& triangle : soup)
      vertices.insert(vertices.end(), triangle.begin(), triangle.end());
    const auto key = [](const Vec3& v) { return std::tuple(v.x, v.y, v.z); };
    std::map<std::tuple<double, double, double>, std::uint32_t> numbers;
    std::shuffle(vertices.begin(), vertices.end(), random);
    std::erase_if(vertices, [&](const Vec3& vertex) {
      return !numbers.emplace(key(vertex), static_cast<std::uint32_t>(numbers.size())).second;
    });
    std::ofstream file(mesh_, std::ios::binary);
    const auto put = [&file](const auto& value) {
      file.write(reinterpret_cast<const char*>(&value), sizeof value);
    };
    file << "ply\nformat binary_little_endian 1.0\nelement vertex " << vertices.size()
         << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
         << soup.size() << "\nproperty list uchar uint vertex_indices\nend_header\n";
    for (const Vec3& vertex : vertices)
      for (const double value : {vertex.x, vertex.y, vertex.z})
        put(static_cast<double>(static_cast<float>(value)));
    for (const auto& triangle : soup) {
      put(std::uint8_t{3});
      for (const Vec3& corner : triangle) put(numbers.at(key(corner)));
    }
  }
  BuildInput input() const { return parts_.empty() ? BuildInput(mesh_) : BuildInput(parts_); }
  storage::Bytes built() const { return storage::read_bytes(output_); }

  storage::TemporaryDirectory folder_;
  storage::TemporaryDirectory meshes_;
  std::filesystem::path mesh_ = meshes_ / "model.stl";
  std::vector<std::filesystem::path> parts_;  // the input in place of mesh_, if there are any
  std::filesystem::path output_ = folder_ / "model.ptree";
};

inline constexpr BuildMemory kLarge{2, 100000, 0, 1 << 30, 1 << 30, 1 << 30, 1 << 30, 1 << 30};
inline constexpr BuildMemory kTight{1, 77, 65536, 0, 0, 0, 0, 0};
// As kTight, with so little memory for the mesh that corners in random order are sorted on disk.
inline constexpr BuildMemory kSortedOnDisk{1, 77, 1000, 0, 0, 0, 0, 0};
inline constexpr BuildMemory kBetween{3, 200, 65536, 30000, 20000, 7000, 5000, 5000};

}  // namespace planetree::octree
