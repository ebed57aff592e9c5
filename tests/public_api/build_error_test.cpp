// Each failure of a build is a value with a code and a text, and names its file or directory.

#include <limits>
#include <optional>

#include "tests/public_api/meshes.h"

namespace planetree::public_api {
namespace {

class BuildErrors : public InFolder {
 protected:
  void expect_error(const BuildInput& input, const std::filesystem::path& output, ErrorCode code,
                    const std::filesystem::path& failed_at) {
    std::optional<std::filesystem::path> path;
    int calls = 0;
    options_.on_failure = [&](const std::filesystem::path& at) { path = at, ++calls; };
    const auto report = build(input, output, options_);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, code) << report.error().text;
    EXPECT_NE(report.error().text[0], '\0');
    EXPECT_EQ(path, failed_at);
    EXPECT_EQ(calls, 1);
  }
  void expect_error(ErrorCode code) { expect_error(mesh_.input(), output(), code, {}); }

  Mesh mesh_ = torus(12, 10);
  BuildOptions options_;
};

TEST_F(BuildErrors, OptionsOutOfRange) {
  options_.page_bytes = 5000;
  expect_error(ErrorCode::kBadArgument);
  options_ = {};
  options_.memory_bytes = BuildOptions::kMinMemoryBytes - 1;
  expect_error(ErrorCode::kNoMemory);
  options_ = {};
  options_.box = {{1, 0, 0}, {0, 1, 1}};
  expect_error(ErrorCode::kBadArgument);
  options_.box = {{0, 0, 0}, {1, std::numeric_limits<double>::quiet_NaN(), 1}};
  expect_error(ErrorCode::kBadArgument);
  EXPECT_TRUE(is_empty());
}

TEST_F(BuildErrors, ABoxThatNothingTouches) {
  options_.box = {{50, 50, 50}, {60, 60, 60}};
  expect_error(ErrorCode::kBadArgument);
  options_.box = {{-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1}};  // in the hole of the torus
  expect_error(ErrorCode::kBadArgument);
}

TEST_F(BuildErrors, PathsOfTheOutput) {
  expect_error(mesh_.input(), folder_, ErrorCode::kBadArgument, folder_);
  const auto nowhere = folder_ / "nowhere" / "model.ptree";
  expect_error(mesh_.input(), nowhere, ErrorCode::kNotFound, nowhere);
  std::ofstream(output()) << "here";
  expect_error(mesh_.input(), output(), ErrorCode::kAlreadyExists, output());
  EXPECT_EQ(bytes_of(output()), "here");
  options_.temp_directory = folder_ / "nowhere";
  options_.replace = true;
  expect_error(mesh_.input(), output(), ErrorCode::kNotFound, options_.temp_directory);
}

TEST_F(BuildErrors, FilesOfTheInput) {
  const auto mesh = folder_ / "mesh.ply";
  expect_error(mesh, output(), ErrorCode::kNotFound, mesh);
  std::ofstream(mesh) << "ply\nformat ascii 1.0\nend_header\n";
  expect_error(mesh, output(), ErrorCode::kBadInput, mesh);
  options_.replace = true;
  expect_error(mesh, mesh, ErrorCode::kBadArgument, mesh);
  EXPECT_FALSE(std::filesystem::exists(output()));
}

TEST_F(BuildErrors, OneOfSeveralFilesOfTheInput) {
  const auto good = folder_ / "good.ply", bad = folder_ / "bad.ply";
  write_ply<float>(good, mesh_);
  const BuildInput both(std::vector<std::filesystem::path>{good, bad});
  expect_error(both, output(), ErrorCode::kNotFound, bad);
  std::ofstream(bad) << "ply\nformat ascii 1.0\nend_header\n";
  expect_error(both, output(), ErrorCode::kBadInput, bad);
  options_.replace = true;
  expect_error(both, bad, ErrorCode::kBadArgument, bad);
  // Of no one of them in particular.
  write_stl(bad, mesh_);
  options_.box = {{50, 50, 50}, {60, 60, 60}};
  expect_error(both, output(), ErrorCode::kBadArgument, {});
  expect_error(BuildInput(std::vector<std::filesystem::path>()), output(), ErrorCode::kBadArgument,
               {});
  EXPECT_FALSE(std::filesystem::exists(output()));
}

TEST_F(BuildErrors, MeshesWithoutATriangle) {
  mesh_.triangles.clear();
  expect_error(ErrorCode::kBadInput);
  expect_error(mesh_.stream(1), output(), ErrorCode::kBadInput, {});
  mesh_.triangles.push_back({0, 1, 4000000000});
  expect_error(ErrorCode::kBadInput);
  mesh_.vertices.clear();
  expect_error(ErrorCode::kBadInput);
}

TEST_F(BuildErrors, BadRecordsIfStrict) {
  mesh_.triangles.push_back({0, 1, 4000000000});
  options_.strict = true;
  expect_error(ErrorCode::kBadInput);
  EXPECT_TRUE(is_empty());
  options_.strict = false;
  EXPECT_TRUE(build(mesh_.input(), output(), options_));
}

}  // namespace
}  // namespace planetree::public_api
