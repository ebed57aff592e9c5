#include "octree/build/mesh_store.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "octree/build/morton_order.h"
#include "octree/octcode.h"
#include "tests/octree/sample_tree.h"

namespace planetree::octree {
namespace {

void add(MeshStore& mesh, std::uint64_t index, const std::array<Vec3, 3>& corners) {
  ASSERT_TRUE(mesh.triangle(index, corners));
}

double longest_edge(const MeshStore& mesh) { return (mesh.upper() - mesh.lower()).maxCoeff(); }

TEST(MeshStore, KeepsFloatsAsFloatsAndGivesThemBack) {
  MeshStore mesh;
  add(mesh, 0, {Vec3{0.5, 1, 2}, Vec3{-3, 0.125, 0}, Vec3{1e-3f, 7, 0}});
  mesh.normalise();
  EXPECT_FALSE(mesh.float64());
  const double scale = std::ldexp(1.0, mesh.scale_exponent());
  EXPECT_EQ(mesh.corners(0)[1], Point(-3, 0.125, 0) * scale);
  EXPECT_EQ(mesh.corners(0)[2].x(), 1e-3f * scale);
}

TEST(MeshStore, TurnsToDoublesAtTheFirstThatFloatsDoNotHold) {
  MeshStore mesh;
  add(mesh, 0, {Vec3{0.5, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}});
  EXPECT_FALSE(mesh.float64());
  add(mesh, 1, {Vec3{0.5, 0, 0}, Vec3{1, 0.1, 0}, Vec3{0, 1, 0}});
  EXPECT_TRUE(mesh.float64());
  mesh.normalise();
  EXPECT_EQ(mesh.corners(0)[0], Point(0.5, 0, 0) * std::ldexp(1.0, mesh.scale_exponent()));
  EXPECT_EQ(mesh.corners(1)[1].y(), std::ldexp(0.1, mesh.scale_exponent()));
}

TEST(MeshStore, ScalesTheLongestEdgeIntoOneToTwo) {
  for (const double size : {1e-300, 3e-39, 1e-3, 0.99, 1.0, 1.01, 12345.0, 3e38, 1e300, 1.7e308}) {
    MeshStore mesh;
    add(mesh, 0, {Vec3{0, 0, 0}, Vec3{size, 0, 0}, Vec3{0, size / 3, 0}});
    add(mesh, 1, {Vec3{0, 0, 0}, Vec3{size, 0, 0}, Vec3{0, 0, -size / 7}});
    mesh.normalise();
    EXPECT_GE(longest_edge(mesh), 1) << size;
    EXPECT_LT(longest_edge(mesh), 2) << size;
    EXPECT_EQ(mesh.input_upper().x(), size);
  }
}

TEST(MeshStore, ScalesBoxesWhoseSizeOverflows) {
  constexpr double kMost = std::numeric_limits<double>::max();
  MeshStore mesh;
  add(mesh, 0, {Vec3{-kMost, 0, 0}, Vec3{kMost, 0, 0}, Vec3{0, 1, 0}});
  mesh.normalise();
  EXPECT_GE(longest_edge(mesh), 1);
  EXPECT_LE(longest_edge(mesh), 2);
}

TEST(MeshStore, ScalesOnePointByItsPlace) {
  MeshStore mesh;
  add(mesh, 0, {Vec3{1000, 0, 0}, Vec3{1000, 0, 0}, Vec3{1000, 0, 0}});
  mesh.normalise();
  EXPECT_LT(std::fabs(mesh.corners(0)[0].x()), 2);
  MeshStore origin;
  add(origin, 0, {Vec3{}, Vec3{}, Vec3{}});
  origin.normalise();
  EXPECT_EQ(origin.scale_exponent(), 0);
}

TEST(MeshStore, KeepsSmallFloatsBesideLargeOnes) {
  // 1e-38 of a model of 1e38 would underflow as a float32.
  MeshStore mesh;
  add(mesh, 0, {Vec3{1e-38f, 0, 0}, Vec3{1e38f, 0, 0}, Vec3{0, 1e38f, 0}});
  mesh.normalise();
  EXPECT_EQ(mesh.corners(0)[0].x(), std::ldexp(double{1e-38f}, mesh.scale_exponent()));
  EXPECT_TRUE(mesh.float64());
}

TEST(MeshStore, CountsIndicesAcrossGaps) {
  const std::array<Vec3, 3> corners{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
  MeshStore mesh;
  SetAside why;
  add(mesh, 0, corners);
  mesh.set_aside(1, 3, why);
  add(mesh, 4, corners);
  add(mesh, 5, corners);
  mesh.set_aside(6, 1, why);
  add(mesh, (std::uint64_t{1} << 32) + 7, corners);
  EXPECT_EQ(mesh.size(), 4u);
  EXPECT_EQ(mesh.index(0), 0u);
  EXPECT_EQ(mesh.index(1), 4u);
  EXPECT_EQ(mesh.index(2), 5u);
  EXPECT_EQ(mesh.index(3), (std::uint64_t{1} << 32) + 7);
  EXPECT_EQ(mesh.set_aside_count(), 4u);
  EXPECT_EQ(mesh.first_set_aside(), 1u);
  EXPECT_EQ(mesh.first_set_aside_text(), why.text());
}

TEST(MortonOrder, SortsByCodeThenPosition) {
  const MeshStore mesh = store(scattered(3000, 0.01));
  const std::vector<MortonKey> keys = morton_order(mesh);
  ASSERT_EQ(keys.size(), 3000u);
  std::vector<bool> seen(keys.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    seen[keys[i].position] = true;
    if (i == 0) continue;
    EXPECT_TRUE(keys[i - 1].code < keys[i].code ||
                (keys[i - 1].code == keys[i].code && keys[i - 1].position < keys[i].position));
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), 3000);
}

TEST(MortonOrder, PutsBoxCentresInTheirCells) {
  const MeshStore mesh = store(scattered(500, 0.01));
  for (const MortonKey& key : morton_order(mesh)) {
    const Triangle t = mesh.corners(key.position);
    const Point centre =
        (t[0].cwiseMin(t[1]).cwiseMin(t[2]) + t[0].cwiseMax(t[1]).cwiseMax(t[2])) / 2;
    const Cell cell = cell_of_octcode(octcode_of_prefix(key.code, kMortonBits));
    const Point corner = mesh.lower() + Point(cell.x, cell.y, cell.z) * 0x1p-18;
    EXPECT_GE((centre - corner).minCoeff(), -1e-12);
    EXPECT_LE((centre - corner).maxCoeff(), 0x1p-18 + 1e-12);
  }
}

TEST(MortonOrder, KeepsEqualTrianglesInTheirOrder) {
  const std::vector<MortonKey> keys = morton_order(store(repeated(300)));
  for (std::uint32_t i = 0; i < keys.size(); ++i) EXPECT_EQ(keys[i].position, i);
}

}  // namespace
}  // namespace planetree::octree
