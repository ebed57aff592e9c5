// Nodes put meshes where the specification says.

#include <gtest/gtest.h>

#include <cmath>

#include "octree/builder/mesh/gltf/gltf_transform.h"
#include "tests/octree/builder/mesh/gltf/gltf_writer.h"

namespace planetree::octree {
namespace {

const std::vector<Position> kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};

/// A scene with one mesh of one triangle.
GltfWriter triangle_scene() {
  GltfWriter scene;
  scene.mesh({scene.primitive(scene.positions(kTriangle))});
  return scene;
}

std::string log_of(const GltfWriter& scene) {
  const Reading reading = read_bytes(scene.glb());
  EXPECT_EQ(reading.error, "");
  return reading.log;
}

TEST(GltfScene, NestsTransforms) {
  GltfWriter scene = triangle_scene();
  // Twice as large, turned by 90 degrees about z, moved.
  scene.node({{"mesh", 0}, {"scale", {2, 2, 2}}});
  scene.node({{"children", {0}}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
  scene.node({{"children", {1}}, {"translation", {10, 20, 30}}});
  scene.add("scenes", {{"nodes", {2}}});
  EXPECT_EQ(log_of(scene), ply_log({{10, 20, 30}, {10, 22, 30}, {6, 20, 30}}, {{0, 1, 2}}));
}

TEST(GltfScene, PlacesAMeshOfSeveralNodesSeveralTimes) {
  GltfWriter scene = triangle_scene();
  scene.mesh({scene.primitive(scene.positions({{5, 5, 5}, {6, 5, 5}, {5, 6, 5}}))});
  scene.node({{"mesh", 0}, {"children", {2, 1}}});
  scene.node({{"mesh", 1}, {"translation", {0, 0, 1}}});
  scene.node({{"mesh", 0}, {"translation", {0, 0, -1}}});
  EXPECT_EQ(log_of(scene), ply_log({{0, 0, 0},
                                    {1, 0, 0},
                                    {0, 2, 0},
                                    {0, 0, -1},
                                    {1, 0, -1},
                                    {0, 2, -1},
                                    {5, 5, 6},
                                    {6, 5, 6},
                                    {5, 6, 6}},
                                   {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}));
}

TEST(GltfScene, TurnsMirroredTriangles) {
  GltfWriter scene = triangle_scene();
  scene.node({{"mesh", 0}, {"scale", {-1, 1, 1}}});
  scene.node({{"mesh", 0}, {"scale", {-1, -1, 1}}});
  scene.node({{"children", {3}}, {"scale", {1, 1, -1}}});
  scene.node({{"mesh", 0}, {"scale", {1, -1, 1}}});
  EXPECT_EQ(log_of(scene),
            ply_log({{0, 0, 0}, {-1, 0, 0}, {0, 2, 0}, {-1, 0, 0}, {0, -2, 0}, {1, 0, 0}},
                    {{0, 2, 1}, {0, 3, 4}, {0, 5, 4}}));
}

TEST(GltfScene, ShowsTheSceneThatIsNamed) {
  GltfWriter scene = triangle_scene();
  scene.node({{"mesh", 0}});
  scene.node({{"mesh", 0}, {"translation", {0, 0, 1}}});
  scene.add("scenes", {{"nodes", {0}}});
  scene.add("scenes", {{"nodes", {1}}});
  const std::string first = ply_log({{0, 0, 0}, {1, 0, 0}, {0, 2, 0}}, {{0, 1, 2}});
  const std::string second = ply_log({{0, 0, 1}, {1, 0, 1}, {0, 2, 1}}, {{0, 1, 2}});
  EXPECT_EQ(log_of(scene), first);
  scene.document["scene"] = 1;
  EXPECT_EQ(log_of(scene), second);
  scene.document["scene"] = 1.0;
  EXPECT_EQ(log_of(scene), second);
}

// Only an exchange of axes and signs leaves floats floats.
TEST(GltfScene, KnowsWhatStaysAFloat) {
  const auto is_float = [](const nlohmann::json& node) {
    GltfWriter scene = triangle_scene();
    nlohmann::json whole = node;
    whole["mesh"] = 0;
    scene.node(whole);
    return read_bytes(scene.glb()).summary->float32;
  };
  EXPECT_TRUE(is_float(nlohmann::json::object()));
  EXPECT_TRUE(is_float({{"matrix", {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1}}}));
  EXPECT_FALSE(is_float({{"translation", {0, 0, 1}}}));
  EXPECT_FALSE(is_float({{"scale", {1, 1, 2}}}));
  EXPECT_FALSE(is_float({{"rotation", {0.6, 0, 0, 0.8}}}));
}

// A quaternion turns a point as the rotation about its axis does, computed in other arithmetic.
TEST(GltfScene, TurnsByQuaternionsOfAnyLength) {
  const std::array<long double, 3> axis = {2.0L / 7, -3.0L / 7, 6.0L / 7};
  const std::array<long double, 3> p = {0.3L, -1.7L, 2.9L};
  for (const long double angle : {0.1L, 1.0L, 3.0L, -2.0L}) {
    for (const long double length : {1.0L, 1.0001L, 7.0L}) {
      const long double s = std::sin(angle / 2) * length;
      const GltfTransform turn = transform_of(
          {10, 0, 0},
          {static_cast<double>(axis[0] * s), static_cast<double>(axis[1] * s),
           static_cast<double>(axis[2] * s), static_cast<double>(std::cos(angle / 2) * length)},
          {1, 1, 1});
      // Rodrigues: p cos + (axis x p) sin + axis (axis . p) (1 - cos)
      const long double dot = axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2];
      const std::array<long double, 3> cross = {axis[1] * p[2] - axis[2] * p[1],
                                                axis[2] * p[0] - axis[0] * p[2],
                                                axis[0] * p[1] - axis[1] * p[0]};
      const Vec3 turned = turn.of(
          {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
      const std::array<double, 3> found = {turned.x - 10, turned.y, turned.z};
      for (std::size_t i = 0; i < 3; ++i) {
        const long double expected = p[i] * std::cos(angle) + cross[i] * std::sin(angle) +
                                     axis[i] * dot * (1 - std::cos(angle));
        EXPECT_NEAR(found[i], static_cast<double>(expected), 1e-14);
      }
    }
  }
}

// A chain of nodes as deep as it may be neither takes the stack nor much time.
TEST(GltfScene, FollowsDeepTrees) {
  GltfWriter scene = triangle_scene();
  constexpr std::size_t kNodes = 100000;
  nlohmann::json nodes = nlohmann::json::array();
  for (std::size_t i = 0; i + 1 < kNodes; ++i)
    nodes.push_back({{"children", {i + 1}}, {"translation", {0, 0, 1}}});
  nodes.push_back({{"mesh", 0}});
  scene.document["nodes"] = nodes;
  EXPECT_EQ(log_of(scene), ply_log({{0, 0, 99999}, {1, 0, 99999}, {0, 2, 99999}}, {{0, 1, 2}}));
}

}  // namespace
}  // namespace planetree::octree
