#pragma once

#include <gtest/gtest.h>
#include <planetree/planetree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

/// Meshes in memory, the files of them, and a folder for each test.
namespace planetree::public_api {

struct Mesh {
  std::vector<Vec3> vertices;
  std::vector<TriangleVertices> triangles;

  BuildInput input() const { return {vertices, triangles}; }
  std::vector<FloatVertex> floats() const {
    std::vector<FloatVertex> all;
    for (const Vec3& v : vertices)
      all.push_back({static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)});
    return all;
  }
  /// The triangles one by one, `at_a_time` or fewer in each call.
  BuildInput stream(std::size_t at_a_time, std::uint64_t expected = 0) const {
    return BuildInput(
        [this, at_a_time,
         next = std::size_t{0}](std::span<TriangleCorners> buffer) mutable -> Result<std::size_t> {
          const std::size_t count = std::min({at_a_time, buffer.size(), triangles.size() - next});
          for (std::size_t i = 0; i < count; ++i, ++next)
            for (std::size_t k = 0; k < 3; ++k) buffer[i][k] = vertices[triangles[next][k]];
          return count;
        },
        expected);
  }
};

/// A torus about the z axis with coordinates that are floats; watertight, oriented outwards.
inline Mesh torus(std::uint32_t round, std::uint32_t along) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < round; ++i)
    for (std::uint32_t k = 0; k < along; ++k) {
      const double a = 2 * std::numbers::pi * i / round, b = 2 * std::numbers::pi * k / along;
      const double r = 2 + 0.75 * std::cos(b);
      const auto rounded = [](double v) { return static_cast<double>(static_cast<float>(v)); };
      mesh.vertices.push_back(
          {rounded(r * std::cos(a)), rounded(r * std::sin(a)), rounded(0.75 * std::sin(b))});
    }
  for (std::uint32_t i = 0; i < round; ++i)
    for (std::uint32_t k = 0; k < along; ++k) {
      const std::uint32_t i1 = (i + 1) % round, k1 = (k + 1) % along;
      mesh.triangles.push_back({i * along + k, i1 * along + k, i1 * along + k1});
      mesh.triangles.push_back({i * along + k, i1 * along + k1, i * along + k1});
    }
  return mesh;
}

template <class Value>
void put(std::ofstream& file, Value value) {
  file.write(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Writes a binary PLY with coordinates of type Real, float or double.
template <class Real>
void write_ply(const std::filesystem::path& path, const Mesh& mesh) {
  const char* const real = sizeof(Real) == 4 ? "float" : "double";
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertices.size();
  for (const char* name : {"x", "y", "z"}) file << "\nproperty " << real << ' ' << name;
  file << "\nelement face " << mesh.triangles.size()
       << "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices)
    for (const double value : {v.x, v.y, v.z}) put(file, static_cast<Real>(value));
  for (const TriangleVertices& triangle : mesh.triangles) {
    put(file, std::uint8_t{3});
    for (const std::uint32_t index : triangle) put(file, index);
  }
}

/// Writes a binary STL.
inline void write_stl(const std::filesystem::path& path, const Mesh& mesh) {
  std::ofstream file(path, std::ios::binary);
  file << std::string(80, ' ');
  put(file, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const TriangleVertices& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put(file, 0.0f);
    for (const std::uint32_t index : triangle) {
      const Vec3& v = mesh.vertices[index];
      for (const double value : {v.x, v.y, v.z}) put(file, static_cast<float>(value));
    }
    put(file, std::uint16_t{0});
  }
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A test with an empty folder of its own.
class InFolder : public testing::Test {
 protected:
  InFolder() {
    const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("planetree_" + std::string(test->test_suite_name()) + "_" + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~InFolder() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  std::filesystem::path output() const { return folder_ / "model.ptree"; }
  bool is_empty() const { return std::filesystem::is_empty(folder_); }

  /// Options of a build that takes little of the machine.
  static BuildOptions small_options() {
    BuildOptions options;
    options.memory_bytes = std::uint64_t{256} << 20;
    options.page_bytes = 4096;
    options.replace = true;
    return options;
  }
  /// The bytes of the file that is built; empty, with a failed test, if the build fails.
  std::string built(const BuildInput& input, const BuildOptions& options = small_options()) const {
    const auto report = build(input, output(), options);
    EXPECT_TRUE(report) << report.error().text;
    return report ? bytes_of(output()) : std::string();
  }

  std::filesystem::path folder_;
};

}  // namespace planetree::public_api
