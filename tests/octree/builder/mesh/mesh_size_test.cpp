#include "octree/builder/mesh/mesh_size.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/octree/builder/mesh/gltf/gltf_writer.h"
#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

struct Declared {
  std::uint64_t vertices, faces;
  std::string format = "binary_little_endian", real = "float";
};

std::string ply(const Declared& declared, const std::string& body) {
  std::string header = "ply\nformat " + declared.format + " 1.0\nelement vertex " +
                       std::to_string(declared.vertices) + "\n";
  for (const char* axis : {"x", "y", "z"})
    header += "property " + declared.real + " " + axis + "\n";
  return header + "element face " + std::to_string(declared.faces) +
         "\nproperty list uchar int vertex_indices\nproperty uchar red\nend_header\n" + body;
}

MeshSize estimate(const std::string& bytes, const std::string& extension) {
  const TemporaryFile file(bytes, extension);
  const auto size = MeshSize::estimate(file.path());
  EXPECT_TRUE(size);
  return *size;
}

void expect_size(const MeshSize& size, std::uint64_t triangles, std::uint64_t vertices,
                 bool float64) {
  EXPECT_EQ(size.triangles, triangles);
  EXPECT_EQ(size.vertices, vertices);
  EXPECT_EQ(size.float64, float64);
}

TEST(MeshSize, CountsTheCornersOfABinaryPly) {
  const std::string three(1 + 3 * 4 + 1, '\3'), five(1 + 5 * 4 + 1, '\5');
  expect_size(estimate(ply({4, 2}, std::string(4 * 12, '\0') + three + three), ".ply"), 2, 4,
              false);
  expect_size(
      estimate(ply({4, 2, "binary_big_endian", "double"}, std::string(4 * 24, '\0') + three + five),
               ".ply"),
      4, 4, true);
}

TEST(MeshSize, AssumesASurfaceForAsciiPly) {
  const std::string rows(400, '0');
  expect_size(estimate(ply({7, 10, "ascii"}, rows), ".ply"), 14, 7, false);
  expect_size(estimate(ply({5, 10, "ascii"}, rows), ".ply"), 10, 5, false);
  expect_size(estimate(ply({30, 10, "ascii", "double"}, rows), ".ply"), 20, 30, true);
}

TEST(MeshSize, EstimatesNothingFromAWrongHeader) {
  for (const char* format : {"ascii", "binary_little_endian"})
    for (const std::uint64_t lie : {std::uint64_t{1000}, ~std::uint64_t{0}}) {
      expect_size(estimate(ply({lie, 2, format}, std::string(100, '0')), ".ply"), 0, 0, false);
      expect_size(estimate(ply({2, lie, format}, std::string(100, '0')), ".ply"), 0, 0, false);
    }
  expect_size(estimate("ply\nformat nonsense\n", ".ply"), 0, 0, false);
  expect_size(estimate("nothing", ".txt"), 0, 0, false);
  expect_size(estimate("{\"asset\": 2}", ".gltf"), 0, 0, false);
}

// What two nodes show is there twice, and one of them moves it.
TEST(MeshSize, CountsWhatAGltfShows) {
  GltfWriter scene;
  const std::size_t positions = scene.positions({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}});
  nlohmann::json strip = GltfWriter::primitive(positions), points = strip;
  strip["mode"] = 5;
  points["mode"] = 0;
  scene.mesh(
      {GltfWriter::primitive(positions, scene.indices({0, 1, 2, 2, 1, 3}, Component::kUint8)),
       strip, points});
  scene.node({{"mesh", 0}});
  const MeshSize once = estimate(scene.glb(), ".glb");
  expect_size(once, 2 + 4, 8, false);
  EXPECT_EQ(once.unpacked_bytes, 0U);
  scene.node({{"mesh", 0}, {"translation", {0, 0, 1}}});
  const MeshSize twice = estimate(scene.embedded(), ".gltf");
  expect_size(twice, 12, 16, true);
  EXPECT_GE(twice.unpacked_bytes, scene.buffer.str().size());
  EXPECT_LE(twice.unpacked_bytes, scene.buffer.str().size() + 3);
}

TEST(MeshSize, CountsTheFacetsOfAnStl) {
  expect_size(estimate("cut off", ".stl"), 0, 0, false);
  std::string binary(84 + 3 * 50, '\0');
  binary[80] = 3;
  expect_size(estimate(binary, ".stl"), 3, 1, false);
}

// Triangles are sampled for any number of them.
TEST(MeshSize, DistinguishesTriangleSoupFromSurfaces) {
  const std::uint32_t count = 60000;
  std::string text = "solid s\n", surface(80, ' '), heap(80, ' ');
  const auto put = [](std::string& to, const auto& value) {
    to.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  for (std::string* stl : {&surface, &heap}) put(*stl, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::string* stl : {&surface, &heap}) stl->append(12, '\0');
    text += "facet normal 0 0 1\nouter loop\n";
    for (std::uint32_t k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        put(surface, i + k);
        put(heap, 3 * i + k);
      }
      text += "vertex 0 " + std::to_string(k) + " " + std::to_string(i) + "\n";
    }
    for (std::string* stl : {&surface, &heap}) stl->append(2, '\0');
    text += "endloop\nendfacet\n";
  }
  expect_size(estimate(surface, ".stl"), count, count / 2, false);
  expect_size(estimate(heap, ".stl"), count, 3 * count, false);
  const MeshSize of_text = estimate(text, ".stl");
  EXPECT_EQ(of_text.vertices, 3 * of_text.triangles);
}

void expect_a_little_more(std::uint64_t found, std::uint64_t true_count) {
  EXPECT_GE(found, true_count);
  EXPECT_LE(found, true_count + true_count / 12);
}

TEST(MeshSize, SamplesLongTexts) {
  std::string obj, stl = "solid s\n";
  const std::uint64_t count = 60000;
  for (std::uint64_t i = 0; i < count; ++i)
    obj += "v 0.25 " + std::to_string(i) + " 7e-5\nvn 0 0 1\n";
  // Quads first, then triangles, with indices of different lengths.
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string corner = " " + std::to_string(i + 1) + "//" + std::to_string(i + 1);
    obj += "f" + corner + corner + corner + (i < count / 3 ? corner : "") + "\n";
  }
  for (std::uint64_t i = 0; i < count / 4; ++i)
    stl += "  Facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 " + std::to_string(i) +
           " 0\n  vertex 0 1 0\n endloop\n endfacet\n";
  const MeshSize of_obj = estimate(obj, ".obj"), of_stl = estimate(stl, ".stl");
  expect_a_little_more(of_obj.triangles, count + count / 3);
  expect_a_little_more(of_obj.vertices, count);
  expect_a_little_more(of_stl.triangles, count / 4);
  EXPECT_TRUE(of_obj.float64 && of_stl.float64);
}

TEST(MeshSize, RefusesMissingFiles) {
  const auto size = MeshSize::estimate("/no/such/mesh.ply");
  ASSERT_FALSE(size);
  EXPECT_EQ(size.error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace planetree::octree
