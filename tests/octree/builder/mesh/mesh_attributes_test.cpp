// Attributes of meshes in memory, and inputs that have none.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

const std::vector<Vec3> kVertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
const std::vector<TriangleVertices> kTriangles = {{0, 1, 2}, {2, 9, 3}, {2, 1, 3}};
const std::vector<Color> kColors = {{1, 2, 3, 4}, {5, 6, 7}, {8, 9, 10}, {11, 12, 13, 0}};
const std::vector<TextureCoordinate> kUvs = {{0, 0}, {0.5F, 0}, {0, 2}, {-1, 1}};
const std::vector<std::uint64_t> kValues = {7, 8, ~std::uint64_t{0}};

template <class Vertex>
BuildInput::Mesh<Vertex> mesh_of(const std::vector<Vertex>& vertices) {
  return {vertices, kTriangles, kColors, kUvs, kValues, ValueKind::kSigned};
}

template <class Vertex>
Reading read_arrays(const BuildInput::Mesh<Vertex>& mesh, std::uint32_t keep) {
  MeshScratch scratch;
  return read_input(mesh, scratch, {.keep = keep});
}

TEST(MeshAttributes, OfArraysComeBehindTheirTriangles) {
  const Reading all = read_arrays(mesh_of(kVertices), kAllAttributes);
  EXPECT_EQ(all.log,
            "0: 0 0 0, 1 0 0, 0 1 0\n"
            "  #01020304 0 0, #050607ff 0.5 0, #08090aff 0 2, value 7\n"
            "1+1 aside: face 1: vertex index 9 is out of range, the mesh has 4 vertices\n"
            "2: 0 1 0, 1 0 0, 1 1 0\n"
            "  #08090aff 0 2, #050607ff 0.5 0, #0b0c0d00 -1 1, value 18446744073709551615\n");
  ASSERT_TRUE(all.summary);
  EXPECT_EQ(all.summary->value_kind, ValueKind::kSigned);
  const std::vector<FloatVertex> floats = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  EXPECT_EQ(read_arrays(mesh_of(floats), kAllAttributes).log, all.log);
}

TEST(MeshAttributes, AreOnlyThoseThatAreKept) {
  const std::string colors = read_arrays(mesh_of(kVertices), kKeepColor).log;
  EXPECT_NE(colors.find("  #01020304 0 0, #050607ff 0 0, #08090aff 0 0, value 0\n"),
            std::string::npos)
      << colors;
  const std::string values = read_arrays(mesh_of(kVertices), kKeepValue).log;
  EXPECT_NE(values.find("  #000000ff 0 0, #000000ff 0 0, #000000ff 0 0, value 7\n"),
            std::string::npos)
      << values;
  for (const std::uint32_t keep : {std::uint32_t{0}, kKeepTriangles})
    EXPECT_EQ(read_arrays(mesh_of(kVertices), keep).log.find('#'), std::string::npos);
}

TEST(MeshAttributes, OfArraysMayBeOfCorners) {
  BuildInput::Mesh<Vec3> mesh = mesh_of(kVertices);
  std::vector<TextureCoordinate> uvs;
  for (int i = 0; i < 9; ++i) uvs.push_back({static_cast<float>(i), 0.5F});
  mesh.uvs = uvs;
  const Reading reading = read_arrays(mesh, kKeepUv);
  EXPECT_NE(reading.log.find(" 0 0.5, #000000ff 1 0.5, #000000ff 2 0.5"), std::string::npos);
  EXPECT_NE(reading.log.find(" 6 0.5, #000000ff 7 0.5, #000000ff 8 0.5"), std::string::npos);
}

TEST(MeshAttributes, OfArraysOfAWrongSizeAreRefused) {
  BuildInput::Mesh<Vec3> mesh = mesh_of(kVertices);
  mesh.colors = mesh.colors.first(3);
  mesh.uvs = mesh.uvs.first(3);
  mesh.values = {};
  EXPECT_EQ(read_arrays(mesh, 0).error, "");
  const Reading colors = read_arrays(mesh, kKeepColor), uvs = read_arrays(mesh, kKeepUv),
                values = read_arrays(mesh, kKeepValue);
  EXPECT_EQ(colors.error, "3 colors for 4 vertices; give as many, or do not keep them");
  EXPECT_EQ(uvs.error,
            "3 uvs for 4 vertices and 3 triangles; give one for each vertex or three for each "
            "triangle, or do not keep them");
  EXPECT_EQ(values.error, "0 values for 3 triangles; give as many, or do not keep them");
  for (const Reading& reading : {colors, uvs, values}) {
    EXPECT_EQ(reading.code, ErrorCode::kBadArgument);
    EXPECT_EQ(reading.log, "");
  }
}

TEST(MeshAttributes, DecideNothing) {
  BuildInput::Mesh<Vec3> mesh = mesh_of(kVertices);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<TextureCoordinate> uvs(4, {nan, 1});
  mesh.uvs = uvs;
  const Reading reading = read_arrays(mesh, kKeepUv);
  EXPECT_EQ(reading.error, "");
  EXPECT_NE(reading.log.find("nan 1, "), std::string::npos);
}

TEST(MeshAttributes, AreRefusedWhereAnInputHasNone) {
  const std::string stl =
      "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
      "endfacet\nendsolid\n";
  const std::string off = "COFF\n3 1 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n3 0 1 2\n";
  EXPECT_EQ(read_kept(stl, ".stl", kKeepTriangles).error, "");
  EXPECT_EQ(read_kept(stl, ".stl", kKeepColor).error,
            "an STL has no colours that are read; give a PLY, OBJ or glTF for --keep color");
  EXPECT_EQ(read_kept(off, ".off", kKeepUv).error,
            "an OFF has no texture coordinates that are read; give a PLY, OBJ or glTF for --keep "
            "uv");
  EXPECT_EQ(read_kept(off, ".off", kKeepValue).error,
            "an OFF has no values of triangles that are read; give a PLY for --keep value");
  MeshScratch scratch;
  const BuildInput callback([](std::span<TriangleCorners>) -> Result<std::size_t> { return 0; });
  const Reading reading = read_input(callback, scratch, {.keep = kAllAttributes});
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_EQ(reading.error,
            "a callback has no colours that are read; give a PLY, OBJ or glTF for --keep color");
}

}  // namespace
}  // namespace planetree::octree
