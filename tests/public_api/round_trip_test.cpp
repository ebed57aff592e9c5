// What is built in a program is what its queries answer.

#include <cfenv>
#include <string>
#include <thread>
#include <vector>

#include "tests/public_api/meshes.h"

namespace planetree::public_api {
namespace {

class RoundTrip : public InFolder {
 protected:
  // A cube of side 2 about the origin.
  static Mesh cube() {
    Mesh mesh;
    for (const double z : {-1, 1})
      for (const double y : {-1, 1})
        for (const double x : {-1, 1}) mesh.vertices.push_back({x, y, z});
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
  }
};

TEST_F(RoundTrip, AnswersOfACube) {
  const Mesh mesh = cube();
  const auto report = build(mesh.input(), output());
  ASSERT_TRUE(report) << report.error().text;
  EXPECT_EQ(report->triangles, 12u);
  EXPECT_EQ(report->input_triangles, 12u);
  EXPECT_EQ(report->skipped, 0u);
  EXPECT_EQ(report->first_skipped, kNoTriangle);
  EXPECT_EQ(report->first_skipped_text, "");
  EXPECT_TRUE(report->watertight());
  EXPECT_EQ(report->file_bytes, std::filesystem::file_size(output()));
  EXPECT_GT(report->peak_resident_bytes, 0u);

  const auto model = Model::open(output());
  ASSERT_TRUE(model) << model.error().text;
  const ModelInfo& info = model->info();
  EXPECT_EQ(info.vertices, 8u);
  EXPECT_EQ(info.content_id[0], report->content_id[0]);
  EXPECT_EQ(info.pages, report->pages);
  EXPECT_EQ(info.nodes, report->nodes);
  EXPECT_EQ(info.blocks, report->blocks);
  EXPECT_EQ(info.levels, report->levels);
  EXPECT_FALSE(info.float64);
  auto probe = Probe::create(*model);
  ASSERT_TRUE(probe);
  const ClosestPoint inside = probe->closest_point({0.25, 0, 0.5});
  EXPECT_EQ(inside.status, Status::kExact);
  EXPECT_EQ(inside.side, Side::kInside);
  EXPECT_EQ(inside.distance, 0.5);
  EXPECT_EQ(inside.normal.z, 1);
  const ClosestPoint outside = probe->closest_point({0, -4, 0});
  EXPECT_EQ(outside.side, Side::kOutside);
  EXPECT_EQ(outside.signed_distance(), 3);
  EXPECT_EQ(outside.point.y, -1);
}

TEST_F(RoundTrip, ReportsAnOpenSurface) {
  Mesh mesh = cube();
  mesh.triangles.pop_back();
  const auto report = build(mesh.input(), output());
  ASSERT_TRUE(report) << report.error().text;
  EXPECT_EQ(report->unbalanced_edges, 3u);
  EXPECT_FALSE(report->watertight());
}

TEST_F(RoundTrip, BuildsTheTrianglesThatTouchABox) {
  const Mesh mesh = torus(40, 30);
  BuildOptions options = small_options();
  options.box = {{1, -1, -1}, {4, 1, 1}};
  const auto report = build(mesh.input(), output(), options);
  ASSERT_TRUE(report) << report.error().text;
  EXPECT_EQ(report->input_triangles, mesh.triangles.size());
  EXPECT_LT(report->triangles, mesh.triangles.size() / 2);
  EXPECT_TRUE(report->watertight()) << "the edges are those of the whole mesh";
  const auto model = Model::open(output());
  ASSERT_TRUE(model);
  EXPECT_TRUE(model->info().has_region);
}

// The caller's modes are put aside, also on the threads that help.
TEST_F(RoundTrip, BuildsTheSameBytesInAnyRoundingMode) {
  const Mesh mesh = torus(300, 200);
  const std::string before = built(mesh.input());
  for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    ASSERT_EQ(std::fesetround(mode), 0);
    BuildOptions options = small_options();
    options.memory_bytes = std::uint64_t{1} << 30;
    options.threads = 3;
    const auto report = build(mesh.input(), output(), options);
    EXPECT_EQ(std::fegetround(), mode);
    std::fesetround(FE_TONEAREST);
    ASSERT_TRUE(report) << report.error().text;
    EXPECT_EQ(bytes_of(output()), before);
  }
}

TEST_F(RoundTrip, BuildsSeveralFilesAtOnce) {
  const Mesh mesh = torus(100, 80);
  const std::string before = built(mesh.input());
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&, i] {
      const auto file = folder_ / ("model" + std::to_string(i));
      EXPECT_TRUE(build(mesh.input(), file, small_options()));
    });
  for (std::thread& thread : threads) thread.join();
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(bytes_of(folder_ / ("model" + std::to_string(i))), before) << i;
}

}  // namespace
}  // namespace planetree::public_api
