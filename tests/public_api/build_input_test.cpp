// The file depends on the triangles and their order, not on how they are given.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/public_api/meshes.h"

namespace planetree::public_api {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class BuildInputForms : public InFolder {
 protected:
  Mesh mesh_ = torus(40, 30);
};

TEST_F(BuildInputForms, AMeshInMemoryGivesTheBytesOfItsFile) {
  write_ply<double>(folder_ / "mesh.ply", mesh_);
  const std::string of_file = built(folder_ / "mesh.ply");
  ASSERT_FALSE(of_file.empty());
  EXPECT_EQ(built(mesh_.input()), of_file);
}

TEST_F(BuildInputForms, SeveralFilesGiveTheBytesOfTheJoinedOne) {
  write_stl(folder_ / "mesh.stl", mesh_);
  const std::string of_file = built(folder_ / "mesh.stl");
  ASSERT_FALSE(of_file.empty());
  std::vector<std::filesystem::path> parts;
  for (std::size_t from = 0; from < mesh_.triangles.size(); from += 900) {
    const std::size_t to = std::min(from + 900, mesh_.triangles.size());
    const Mesh part{mesh_.vertices,
                    {mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(from),
                     mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(to)}};
    parts.push_back(folder_ / ("part-" + std::to_string(parts.size()) + ".stl"));
    write_stl(parts.back(), part);
  }
  ASSERT_EQ(parts.size(), 3u);
  EXPECT_EQ(built(BuildInput(parts)), of_file);
  EXPECT_EQ(built(BuildInput(std::vector{folder_ / "mesh.stl"})), of_file);

  // By the steps of a job.
  const auto job = folder_ / "job";
  ASSERT_TRUE(plan_shards(parts, job, 2, small_options()));
  for (std::uint32_t shard = 0; shard < 2; ++shard) ASSERT_TRUE(map_shard(job, shard));
  for (std::uint32_t shard = 0; shard < 2; ++shard) ASSERT_TRUE(reduce_shard(job, shard));
  ASSERT_TRUE(merge_shards(job, output(), small_options()));
  EXPECT_EQ(bytes_of(output()), of_file);
  EXPECT_TRUE(plan_shards(folder_ / "mesh.stl", job, 2, small_options()));
}

TEST_F(BuildInputForms, FloatsGiveTheBytesOfDoublesOfTheSameValues) {
  write_ply<float>(folder_ / "mesh.ply", mesh_);
  const std::string of_file = built(folder_ / "mesh.ply");
  const auto floats = mesh_.floats();
  EXPECT_EQ(built({floats, mesh_.triangles}), of_file);
  EXPECT_EQ(built(mesh_.input()), of_file);
}

TEST_F(BuildInputForms, DoublesThatNoFloatHoldsStayDoubles) {
  for (Vec3& v : mesh_.vertices) v.x += 0x1p-40;
  write_ply<double>(folder_ / "mesh.ply", mesh_);
  const std::string of_file = built(folder_ / "mesh.ply");
  EXPECT_EQ(built(mesh_.input()), of_file);
  const auto model = Model::open(output());
  ASSERT_TRUE(model);
  EXPECT_TRUE(model->info().float64);
}

TEST_F(BuildInputForms, ACallbackGivesTheBytesOfAnStl) {
  write_stl(folder_ / "mesh.stl", mesh_);
  const std::string of_file = built(folder_ / "mesh.stl");
  for (const std::size_t at_a_time : {std::size_t{1}, std::size_t{77}, std::size_t{1} << 20})
    EXPECT_EQ(built(mesh_.stream(at_a_time)), of_file) << at_a_time;
  for (const std::uint64_t expected : {std::uint64_t{3}, std::uint64_t{1000000}})
    EXPECT_EQ(built(mesh_.stream(50, expected)), of_file) << expected;
}

// Vertices are counted otherwise. Nothing else of the model differs.
TEST_F(BuildInputForms, ACallbackAndAMeshDifferInTheNumberOfVertices) {
  const auto of_mesh = build(mesh_.input(), folder_ / "mesh.ptree");
  const auto of_stream = build(mesh_.stream(100), folder_ / "stream.ptree");
  ASSERT_TRUE(of_mesh && of_stream);
  EXPECT_EQ(of_mesh->vertices, mesh_.vertices.size());
  EXPECT_EQ(of_stream->vertices, 3 * mesh_.triangles.size());
  EXPECT_EQ(of_mesh->content_id[0], of_stream->content_id[0]);
  EXPECT_EQ(of_mesh->content_id[1], of_stream->content_id[1]);
}

TEST_F(BuildInputForms, BadTrianglesAreSkippedAndCounted) {
  mesh_.vertices.push_back({0, kNan, 0});
  const auto bad = static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  mesh_.triangles.insert(mesh_.triangles.begin() + 5, {0, 1, bad});
  mesh_.triangles.insert(mesh_.triangles.begin() + 9, {0, 1, bad + 1});
  const auto report = build(mesh_.input(), output(), small_options());
  ASSERT_TRUE(report) << report.error().text;
  EXPECT_EQ(report->triangles, mesh_.triangles.size() - 2);
  EXPECT_EQ(report->skipped, 2u);
  EXPECT_EQ(report->first_skipped, 5u);
  EXPECT_EQ(report->first_skipped_text, "face 5: vertex 1200 is not finite");
  const std::string of_memory = bytes_of(output());
  write_ply<double>(folder_ / "mesh.ply", mesh_);
  EXPECT_EQ(built(folder_ / "mesh.ply"), of_memory);
}

TEST_F(BuildInputForms, DigitsThatAFloatLosesAreToldOrRead) {
  std::ofstream(folder_ / "digits.ply")
      << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "5155487.512 0 0\n5155488.25 0 0\n5155487.512 1 0\n3 0 1 2\n";
  BuildOptions options = small_options();
  for (const bool float64 : {false, true}) {
    options.float64 = float64;
    options.replace = true;
    const auto report = build(folder_ / "digits.ply", output(), options);
    ASSERT_TRUE(report) << report.error().text;
    EXPECT_EQ(report->notes.size(), float64 ? 0u : 1u);
    const auto model = Model::open(output());
    ASSERT_TRUE(model);
    EXPECT_EQ(model->info().box_lower.x, float64 ? 5155487.512 : 5155487.5);
  }
}

TEST_F(BuildInputForms, BadTrianglesOfACallbackAreNamed) {
  mesh_.vertices.push_back({0, kNan, 0});
  mesh_.triangles.insert(mesh_.triangles.begin() + 5,
                         {0, static_cast<std::uint32_t>(mesh_.vertices.size() - 1), 1});
  const auto report = build(mesh_.stream(3), output(), small_options());
  ASSERT_TRUE(report) << report.error().text;
  EXPECT_EQ(report->first_skipped_text, "triangle 5: corner 1 is not finite");
  EXPECT_EQ(report->skipped, 1u);
}

TEST_F(BuildInputForms, NegativeZerosAreZeros) {
  const std::string before = built(mesh_.input());
  for (Vec3& v : mesh_.vertices)
    if (v.z == 0) v.z = -0.0;
  EXPECT_EQ(built(mesh_.input()), before);
}

TEST_F(BuildInputForms, NoThreadsMemoryOrRoundingModeChangesTheBytes) {
  const std::string before = built(mesh_.input());
  BuildOptions options = small_options();
  options.memory_bytes = BuildOptions::kMinMemoryBytes;
  options.threads = 1;
  EXPECT_EQ(built(mesh_.input(), options), before);
  options.memory_bytes = std::uint64_t{1} << 30;
  options.threads = 3;
  EXPECT_EQ(built(mesh_.input(), options), before);
}

}  // namespace
}  // namespace planetree::public_api
