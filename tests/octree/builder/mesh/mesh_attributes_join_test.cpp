// The attributes of one mesh in several formats, with its faces in order and in random order.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/octree/builder/mesh/gltf/gltf_writer.h"

namespace planetree::octree {
namespace {

struct Mesh {
  std::vector<Position> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A grid whose vertices have an own colour and texture coordinate each.
Mesh grid(unsigned side) {
  Mesh mesh;
  for (unsigned i = 0; i < side * side; ++i)
    mesh.vertices.push_back({static_cast<float>(i / side), static_cast<float>(i % side), 0});
  for (unsigned i = 0; i + side + 1 < side * side; ++i)
    if (i % side + 1 < side) mesh.triangles.push_back({i, i + 1, i + side});
  return mesh;
}

Mesh in_random_order(Mesh mesh) {
  std::mt19937 random(7);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  return mesh;
}

std::array<std::uint8_t, 3> color_of(std::size_t i) {
  return {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8), 17};
}
std::array<float, 2> uv_of(std::size_t i) {
  return {static_cast<float>(i) / 4, static_cast<float>(i % 3)};
}

std::string ply(const Mesh& mesh, const char* encoding) {
  const bool is_text = std::string(encoding) == "ascii";
  Bytes bytes(std::string(encoding) == "binary_big_endian" ? std::endian::big
                                                           : std::endian::little);
  bytes.text("ply\nformat " + std::string(encoding) + " 1.0\nelement vertex " +
             std::to_string(mesh.vertices.size()) +
             "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
             "property uchar green\nproperty uchar blue\nproperty float s\nproperty float t\n"
             "element face " +
             std::to_string(mesh.triangles.size()) +
             "\nproperty list uchar uint vertex_indices\nend_header\n");
  const auto put = [&](auto... values) {
    if (is_text) {
      ((bytes.text(std::to_string(values) + " ")), ...);
    } else {
      bytes.put(values...);
    }
  };
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const auto [r, g, b] = color_of(i);
    const auto [s, t] = uv_of(i);
    put(mesh.vertices[i][0], mesh.vertices[i][1], mesh.vertices[i][2], r, g, b, s, t);
    if (is_text) bytes.text("\n");
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    put(std::uint8_t{3}, a, b, c);
    if (is_text) bytes.text("\n");
  }
  return bytes.str();
}

/// Texture vertices are in another order than vertices.
std::string obj(const Mesh& mesh) {
  std::string text;
  const auto words = [](auto... values) { return (... + (" " + std::to_string(values))); };
  const std::size_t count = mesh.vertices.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto [r, g, b] = color_of(i);
    const auto& [x, y, z] = mesh.vertices[i];
    text += "v" + words(x, y, z, r / 255.0, g / 255.0, b / 255.0) + "\n";
    const auto [s, t] = uv_of(count - 1 - i);
    text += "vt" + words(s, t) + "\n";
  }
  for (const auto& triangle : mesh.triangles) {
    text += "f";
    for (const std::uint32_t i : triangle) text += words(i + 1) + "/" + std::to_string(count - i);
    text += "\n";
  }
  return text;
}

std::string glb(const Mesh& mesh) {
  GltfWriter scene;
  Bytes colors, uvs;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const auto [r, g, b] = color_of(i);
    const auto [s, t] = uv_of(i);
    colors.put(r, g, b, std::uint8_t{255});
    uvs.put(s, t);
  }
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : mesh.triangles)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  nlohmann::json primitive = GltfWriter::primitive(scene.positions(mesh.vertices),
                                                   scene.indices(corners, Component::kUint32));
  const std::size_t count = mesh.vertices.size();
  const std::size_t color = scene.accessor(scene.view(colors), Component::kUint8, count, "VEC4");
  scene.document["accessors"][color]["normalized"] = true;
  primitive["attributes"]["COLOR_0"] = color;
  primitive["attributes"]["TEXCOORD_0"] =
      scene.accessor(scene.view(uvs), Component::kFloat, count, "VEC2");
  scene.mesh({primitive});
  return scene.glb();
}

Reading read_counted(const std::string& bytes, const std::string& extension,
                     std::uint64_t memory_bytes, int& sorts) {
  const TemporaryFile file(bytes, extension);
  MeshScratch scratch(memory_bytes);
  sorts = 0;
  scratch.before_sorting([&] {
    ++sorts;
    return Result<void>();
  });
  return read_input(file.path(), scratch, {.keep = kKeepColor | kKeepUv});
}

TEST(MeshAttributesJoin, GivesTheSameOfEachFormatAndWithAnyMemory) {
  for (const bool is_random : {false, true}) {
    const Mesh mesh = is_random ? in_random_order(grid(60)) : grid(60);
    const std::string expected =
        read_kept(ply(mesh, "binary_little_endian"), ".ply", kKeepColor | kKeepUv).log;
    EXPECT_EQ(std::count(expected.begin(), expected.end(), '\n'), 2 * std::ssize(mesh.triangles));
    for (const auto& [bytes, extension] :
         {std::pair(ply(mesh, "ascii"), ".ply"),
          std::pair(ply(mesh, "binary_little_endian"), ".ply"),
          std::pair(ply(mesh, "binary_big_endian"), ".ply"), std::pair(obj(mesh), ".obj"),
          std::pair(glb(mesh), ".glb")}) {
      for (const std::uint64_t memory : {std::uint64_t{1} << 20, std::uint64_t{20000}}) {
        int sorts = 0;
        const Reading reading = read_counted(bytes, extension, memory, sorts);
        EXPECT_EQ(reading.error, "");
        EXPECT_TRUE(reading.log == expected) << extension << " with " << memory;
        EXPECT_EQ(sorts, is_random && memory == 20000 ? 1 : 0) << extension;
      }
    }
  }
}

/// Expects the fan of a polygon whose corner k has k for u.
class FanChecker final : public TriangleSink {
 public:
  Result<void> triangle(std::uint64_t, const std::array<Vec3, 3>&) override {
    ++triangles;
    return {};
  }
  Result<void> attributes(const TriangleAttributes& attributes) override {
    const auto second = static_cast<float>(triangles);
    const std::array<TextureCoordinate, 3> expected = {{{0, 1}, {second, 1}, {second + 1, 1}}};
    if (attributes.uvs != expected) ++wrong;
    return {};
  }
  void skipped(std::uint64_t, std::uint64_t count, const SkippedRecord&) override {
    wrong += count;
  }
  Result<void> progress(std::uint64_t, std::uint64_t) override { return {}; }

  std::uint64_t triangles = 0, wrong = 0;
};

TEST(MeshAttributesJoin, HoldsForAPolygonThatIsNotInMemory) {
  // More corners than PolygonTriangulator::kMaxCorners.
  constexpr std::uint32_t kCorners = (1U << 20) + 2;
  Bytes bytes;
  bytes.text(
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uint uchar vertex_indices\nproperty list uint float texcoord\nend_header\n");
  bytes.put(0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, kCorners);
  for (std::uint32_t i = 0; i < kCorners; ++i) bytes.put(static_cast<std::uint8_t>(i % 3));
  bytes.put(2 * kCorners);
  for (std::uint32_t i = 0; i < kCorners; ++i) bytes.put(static_cast<float>(i), 1.0F);
  const TemporaryFile file(bytes.str(), ".ply");
  MeshScratch scratch;
  FanChecker checker;
  const auto summary = read_mesh(file.path(), checker, scratch, {.keep = kKeepUv});
  ASSERT_TRUE(summary) << summary.error().text;
  EXPECT_EQ(checker.triangles, kCorners - 2);
  EXPECT_EQ(checker.wrong, 0u);
}

}  // namespace
}  // namespace planetree::octree
