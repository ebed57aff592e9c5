// Files that are built without some layers.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/public_api/meshes.h"

namespace planetree::public_api {
namespace {

// A torus, one without some triangles, and the queries for both.
class BuildLayers : public InFolder {
 protected:
  static Mesh closed() { return torus(60, 40); }
  static Mesh open() {
    Mesh mesh = torus(60, 40);
    mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 100);
    return mesh;
  }
  static std::vector<Vec3> queries() {
    std::vector<Vec3> points;
    for (int i = 0; i < 200; ++i)
      points.push_back({3 * std::sin(1.7 * i), 3 * std::cos(2.3 * i), std::sin(0.9 * i)});
    return points;
  }
  Model build_and_open(const Mesh& mesh, std::uint32_t layers) const {
    BuildOptions options = small_options();
    options.layers = layers;
    const auto report = build(mesh.input(), output(), options);
    EXPECT_TRUE(report) << report.error().text;
    auto model = Model::open(output());
    EXPECT_TRUE(model) << model.error().text;
    const std::uint32_t expected = (layers & ~kAttributeLayer) | kDistanceLayer;
    EXPECT_EQ(report->layers, expected);
    EXPECT_EQ(model->info().layers, expected);
    EXPECT_EQ(model->stats().layers, expected);
    EXPECT_EQ(model->info().watertight(), report->watertight());
    return *std::move(model);
  }
};

TEST_F(BuildLayers, AreThoseOfTheFile) {
  for (const bool is_closed : {true, false}) {
    const Mesh mesh = is_closed ? closed() : open();
    for (const std::uint32_t layers : {0U, kSideLayer, kFieldLayer, kAllLayers}) {
      const Model model = build_and_open(mesh, layers);
      const ModelInfo& info = model.info();
      const bool has_side = (layers & kSideLayer) != 0;
      EXPECT_EQ(info.watertight(), is_closed);
      EXPECT_EQ(info.section_bytes.mask_pages > 0, has_side);
      EXPECT_EQ(info.section_bytes.cap_pages > 0, has_side && !is_closed);
      EXPECT_EQ(info.caps > 0, has_side && !is_closed);
      EXPECT_EQ(info.section_bytes.field_pages > 0, (layers & kFieldLayer) != 0);
    }
  }
}

TEST_F(BuildLayers, DoNotChangeDistances) {
  for (const Mesh& mesh : {closed(), open()}) {
    const Model whole = build_and_open(mesh, kAllLayers);
    auto all = Probe::create(whole);
    for (const std::uint32_t layers : {kDistanceLayer, kSideLayer, kFieldLayer}) {
      const Model model = build_and_open(mesh, layers);
      auto probe = Probe::create(model);
      for (const Vec3& query : queries()) {
        const ClosestPoint truth = all->closest_point(query, {.parts = kDistance});
        const ClosestPoint answer = probe->closest_point(query, {.parts = kDistance});
        EXPECT_EQ(answer.distance, truth.distance);
        EXPECT_EQ(answer.lower, truth.lower);
        EXPECT_EQ(answer.upper, truth.upper);
        EXPECT_EQ(answer.triangle, truth.triangle);
        EXPECT_EQ(answer.status, Status::kExact);
        const Containment side = probe->contains(query);
        EXPECT_EQ(side.side, layers == kSideLayer ? all->contains(query).side : Side::kUnknown);
        const QueryOptions by_surface{.side_rule = SideRule::kSurface};
        EXPECT_EQ(probe->contains(query, by_surface).side, all->contains(query, by_surface).side);
      }
    }
  }
}

TEST_F(BuildLayers, GiveTheSameBytesForAnyMemoryAndThreads) {
  const Mesh mesh = open();
  BuildOptions options = small_options();
  options.layers = kDistanceLayer;
  options.threads = 1;
  const std::string bytes = built(mesh.input(), options);
  EXPECT_EQ(built(mesh.input()).size() > bytes.size(), true);
  options.threads = 3;
  options.memory_bytes = std::uint64_t{1} << 30;
  EXPECT_EQ(built(mesh.stream(7), options).size(), bytes.size());
  EXPECT_EQ(built(mesh.input(), options), bytes);
  options.threads = 1;
  options.memory_bytes = BuildOptions::kMinMemoryBytes;
  EXPECT_EQ(built(mesh.input(), options), bytes);
  options.layers = 0;
  EXPECT_EQ(built(mesh.input(), options), bytes);
  options.resume = true;
  EXPECT_EQ(built(mesh.input(), options), bytes);
}

TEST_F(BuildLayers, RefuseBitsThatAreNone) {
  BuildOptions options = small_options();
  options.layers = kAllLayers + 1;
  const auto report = build(closed().input(), output(), options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadArgument);
  EXPECT_TRUE(is_empty());
}

TEST_F(BuildLayers, HoldForRegions) {
  const Mesh mesh = open();
  BuildOptions options = small_options();
  options.box = Box{{0, 0, -1}, {3, 3, 1}};
  options.layers = kDistanceLayer;
  ASSERT_FALSE(built(mesh.input(), options).empty());
  const auto model = Model::open(output());
  ASSERT_TRUE(model) << model.error().text;
  EXPECT_TRUE(model->info().has_region);
  EXPECT_FALSE(model->info().watertight());
  auto probe = Probe::create(*model);
  const ClosestPoint answer = probe->closest_point({1.5, 1.5, 0.1}, {.parts = kDistance});
  EXPECT_EQ(answer.status, Status::kExact);
  EXPECT_EQ(probe->contains({1.5, 1.5, 0.1}).side, Side::kUnknown);
}

}  // namespace
}  // namespace planetree::public_api
