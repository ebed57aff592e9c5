#include "tools/generate.h"
#include "tests/tools/cli/captured_console.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "storage/file/checksum.h"
#include "tools/shapes/generate_ply.h"

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Generate : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "planetree-XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    output_ = (folder_ / "model.ply").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// Runs `planetree generate` with these words, keeps its output and returns the exit status.
  int run(std::vector<std::string> words) {
    words.insert(words.begin(), "generate");
    // The model itself is written to the descriptor of standard output.
    testing::internal::CaptureStdout();
    const Outcome outcome = tools::run(words);
    said_ = testing::internal::GetCapturedStdout() + outcome.output;
    complained_ = outcome.errors;
    return outcome.status;
  }

  fs::path folder_;
  std::string output_;
  std::string said_;
  std::string complained_;
};

struct Golden {
  ShapeKind kind;
  std::uint64_t hash;
};

// Equal on every compiler and machine. A change here changes every model that people have generated
// and measured with.
constexpr Golden kGoldens[] = {
    {ShapeKind::kStatue, 2860983112225372389U},    {ShapeKind::kSphere, 15310695791135817050U},
    {ShapeKind::kCylinder, 18413768334433729037U}, {ShapeKind::kCone, 18185607728681744585U},
    {ShapeKind::kTerrain, 18170333687312948610U},  {ShapeKind::kSoup, 5008297482246357500U},
};

TEST_F(Generate, WritesTheSameBytesEverywhere) {
  for (const auto& [kind, hash] : kGoldens) {
    const std::string name(shape_name(kind));
    ASSERT_EQ(run({output_, "--triangles", "50K", "--shape", name, "--seed", "7", "--force"}), 0);
    const std::string bytes = content(output_);
    EXPECT_EQ(storage::hash64(std::as_bytes(std::span(bytes))), hash) << name;
  }
}

TEST_F(Generate, WritesHeaderVerticesAndTriangles) {
  ASSERT_EQ(run({output_, "--triangles", "1", "--shape", "cylinder"}), 0);
  const std::string bytes = content(output_);
  const std::string header =
      "ply\nformat binary_little_endian 1.0\n"
      "comment planetree cylinder of 12 triangles, seed 1; lengths may be read as millimetres\n"
      "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
  ASSERT_EQ(bytes.size(), header.size() + 8 * 12 + 12 * 13);
  EXPECT_EQ(bytes.substr(0, header.size()), header);
  float first[3], last[3];
  std::memcpy(first, &bytes[header.size()], sizeof first);
  std::memcpy(last, &bytes[header.size() + 7 * 12], sizeof last);
  EXPECT_FLOAT_EQ(first[0], -70.710678F);
  EXPECT_FLOAT_EQ(first[1], -70.710678F);
  EXPECT_EQ(first[2], -100);
  EXPECT_FLOAT_EQ(last[0], 70.710678F);
  EXPECT_EQ(last[2], 100);
  const std::size_t faces = header.size() + 8 * 12;
  for (std::size_t face = 0; face < 12; ++face) {
    EXPECT_EQ(bytes[faces + 13 * face], 3);
    std::uint32_t corners[3];
    std::memcpy(corners, &bytes[faces + 13 * face + 1], sizeof corners);
    for (const std::uint32_t corner : corners) EXPECT_LT(corner, 8U);
  }
}

/// A shape with counts only.
class Counts final : public Shape {
 public:
  Counts(std::uint64_t vertices, std::uint64_t triangles)
      : vertices_(vertices), triangles_(triangles) {}
  std::uint64_t vertex_count() const override { return vertices_; }
  std::uint64_t triangle_count() const override { return triangles_; }
  Vec3 vertex(std::uint64_t) const override { return {}; }
  std::array<std::uint64_t, 3> triangle(std::uint64_t) const override { return {0, 0, 0}; }

 private:
  std::uint64_t vertices_, triangles_;
};

TEST_F(Generate, ChoosesAnIndexTypeThatHoldsEveryIndex) {
  const std::uint64_t half = std::uint64_t{1} << 31;
  // "int" and "uint" differ by one byte in the header.
  EXPECT_EQ(ply_bytes(Counts(half + 1, 0), "c") - ply_bytes(Counts(half, 0), "c"), 12U + 1U);
}

TEST_F(Generate, PredictsTheSizeOfTheFile) {
  for (const ShapeKind kind : kAllShapeKinds) {
    const auto shape = make_shape(kind, 40'000, 1);
    ASSERT_TRUE(shape);
    auto file = OutputFile::create(output_, true);
    ASSERT_TRUE(file);
    Progress progress(true, false);
    ASSERT_TRUE(write_ply(**shape, "a comment", *file, progress));
    EXPECT_EQ(file->bytes_written(), ply_bytes(**shape, "a comment"));
  }
}

TEST_F(Generate, ReportsAsOneJsonObject) {
  ASSERT_EQ(run({output_, "--triangles", "5K", "--seed", "3", "--json"}), 0);
  const auto report = nlohmann::json::parse(said_);
  EXPECT_EQ(report["file"], output_);
  EXPECT_EQ(report["shape"], "statue");
  EXPECT_EQ(report["seed"], 3);
  EXPECT_EQ(report["triangles"], 4800);
  EXPECT_EQ(report["vertices"], 2402);
  EXPECT_EQ(report["file_bytes"], fs::file_size(output_));
  EXPECT_GE(report["seconds"].get<double>(), 0);
  EXPECT_GT(report["peak_resident_bytes"].get<std::uint64_t>(), 0U);
  EXPECT_EQ(complained_, "");
}

TEST_F(Generate, WritesTheModelToStandardOutputAndTheReportToStandardError) {
  ASSERT_EQ(run({output_, "--triangles", "500"}), 0);
  ASSERT_EQ(run({"-", "--triangles", "500", "--json"}), 0);
  EXPECT_EQ(said_, content(output_));
  EXPECT_EQ(nlohmann::json::parse(complained_)["triangles"], 432);
}

TEST_F(Generate, RefusesToReplaceUnlessForced) {
  ASSERT_EQ(run({output_, "--triangles", "100"}), 0);
  const std::string before = content(output_);
  EXPECT_EQ(run({output_, "--triangles", "1000"}), 2);
  EXPECT_EQ(complained_.find("planetree: " + output_ + ": "), 0U);
  EXPECT_NE(complained_.find("--force"), std::string::npos);
  EXPECT_EQ(std::count(complained_.begin(), complained_.end(), '\n'), 1);
  EXPECT_EQ(content(output_), before);
  EXPECT_EQ(run({output_, "--triangles", "1000", "--force"}), 0);
  EXPECT_GT(content(output_).size(), before.size());
}

TEST_F(Generate, RefusesBadArguments) {
  EXPECT_EQ(run({output_}), 2);
  EXPECT_EQ(run({"--triangles", "100"}), 2);
  EXPECT_EQ(run({output_, "--triangles", "many"}), 2);
  EXPECT_NE(complained_.find("'many'"), std::string::npos);
  EXPECT_EQ(run({output_, "--triangles", "-5"}), 2);
  EXPECT_EQ(run({output_, "--triangles", "0"}), 2);
  EXPECT_EQ(run({output_, "--triangles", "10G"}), 2);
  EXPECT_EQ(run({output_, "--triangles", "100", "--shape", "teapot"}), 2);
  EXPECT_EQ(run({output_, "--triangles", "100", "--seed", "-1"}), 2);
  EXPECT_EQ(run({output_, "--triangles", "100", "--holes", "90"}), 2);
  EXPECT_NE(complained_.find("half"), std::string::npos);
  EXPECT_EQ(run({output_, "--triangles", "100", "--colour"}), 2);
  EXPECT_EQ(run({(folder_ / "absent/model.ply").string(), "--triangles", "100"}), 2);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Generate, ReportsAFullDeviceAsTheMachinesFault) {
  EXPECT_EQ(run({"/dev/full", "--triangles", "100"}), 3);
  EXPECT_EQ(complained_.find("planetree: /dev/full: at byte 0: cannot write: "), 0U);
}

}  // namespace
}  // namespace planetree::tools
