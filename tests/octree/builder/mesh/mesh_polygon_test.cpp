#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "octree/builder/mesh/stream/polygon_triangulator.h"
#include "tests/octree/builder/mesh/mesh_formats.h"
#include "tests/octree/builder/mesh/mesh_recorder.h"
#include "tests/octree/support/polygon_shapes.h"

namespace planetree::octree {
namespace {

/// A mesh of flat polygons, one above the other, from height 0 on.
PlainMesh stack_of(const std::vector<FlatPolygon>& polygons) {
  PlainMesh mesh;
  for (const FlatPolygon& polygon : polygons) {
    std::vector<std::int64_t>& face = mesh.faces.emplace_back();
    const auto height = static_cast<float>(mesh.faces.size() - 1);
    for (const auto& [u, v] : polygon) {
      face.push_back(static_cast<std::int64_t>(mesh.vertices.size()));
      mesh.vertices.push_back({static_cast<float>(u), static_cast<float>(v), height});
    }
  }
  return mesh;
}

class MeshPolygons : public testing::TestWithParam<MeshFormat> {};
INSTANTIATE_TEST_SUITE_P(All, MeshPolygons,
                         testing::ValuesIn(formats_that([](const MeshFormat& format) {
                           return format.has_polygons;
                         })),
                         [](const auto& made) { return std::string(made.param.name); });

// A dart between two squares: whether corners are joined with vertices in memory or on disk.
TEST_P(MeshPolygons, KeepTheirIndicesInTheOrderOfTheInput) {
  const FlatPolygon square = {{0, 0}, {2, 0}, {2, 2}, {0, 2}};
  const FlatPolygon dart = {{4, 0}, {1, 1}, {0, 4}, {0, 0}};
  const PlainMesh mesh = stack_of({square, dart, square});
  const std::string expected =
      "0: 0 0 0, 2 0 0, 2 2 0\n1: 0 0 0, 2 2 0, 0 2 0\n"
      "2: 0 0 1, 4 0 1, 1 1 1\n3: 1 1 1, 0 4 1, 0 0 1\n"
      "4: 0 0 2, 2 0 2, 2 2 2\n5: 0 0 2, 2 2 2, 0 2 2\n";
  for (const std::uint64_t memory : {std::uint64_t{1} << 12, MeshScratch::kMemoryBytes}) {
    const Reading reading = read_bytes(GetParam().write(mesh, {}), GetParam().extension, memory);
    EXPECT_EQ(reading.log, expected);
    ASSERT_TRUE(reading.summary);
    EXPECT_EQ(reading.summary->odd_polygons.fanned, 0U);
  }
}

TEST_P(MeshPolygons, GiveTheSameTrianglesWhateverTheMemory) {
  const PlainMesh mesh = stack_of({comb(300, 9), spiral(80), keyholes(6), star()});
  const std::string bytes = GetParam().write(mesh, {});
  const Reading much = read_bytes(bytes, GetParam().extension);
  const Reading little = read_bytes(bytes, GetParam().extension, 1 << 12);
  ASSERT_TRUE(much.summary) << much.error;
  EXPECT_EQ(much.log, little.log);
  EXPECT_EQ(much.summary->odd_polygons.fanned, 0U);
  EXPECT_EQ(much.summary->triangle_indices, mesh.vertices.size() - 2 * mesh.faces.size());
}

TEST_P(MeshPolygons, AreCountedWhereTheyAreOdd) {
  PlainMesh mesh = stack_of({{{0, 0}, {4, 4}, {4, 0}, {0, 4}}, u_shape(), u_shape()});
  mesh.vertices.back()[2] = 5;
  const Reading reading = read_bytes(GetParam().write(mesh, {}), GetParam().extension);
  ASSERT_TRUE(reading.summary) << reading.error;
  const OddPolygons& odd = reading.summary->odd_polygons;
  EXPECT_EQ(odd.fanned, 1U);
  EXPECT_TRUE(odd.first_fanned.ends_with(": a polygon of 4 corners crosses itself"));
  EXPECT_EQ(odd.nonplanar, 1U);
  EXPECT_TRUE(odd.first_nonplanar.ends_with(": a polygon of 8 corners is neither convex nor flat"));
}

TEST_P(MeshPolygons, StayFansWhereTheyAreTooLong) {
  PlainMesh mesh = stack_of({{{0, 0}, {1, 0}, {0, 1}}});
  // The corners are those of the triangle, over and over.
  mesh.faces.push_back({});
  for (std::size_t k = 0; k <= PolygonTriangulator::kMaxCorners; ++k)
    mesh.faces.back().push_back(static_cast<std::int64_t>(k % 3));
  const TemporaryFile file(GetParam().write(mesh, {}), GetParam().extension);
  const Reading reading = read_path(file.path());
  ASSERT_TRUE(reading.summary) << reading.error;
  EXPECT_EQ(reading.summary->triangle_indices, PolygonTriangulator::kMaxCorners);
  EXPECT_TRUE(reading.summary->odd_polygons.first_fanned.ends_with(
      ": a polygon of 1048577 corners is too long to be examined"));
}

}  // namespace
}  // namespace planetree::octree
