#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

using Corner = std::array<double, 3>;

double dot(const Corner& a, const Corner& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Corner minus(const Corner& a, const Corner& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

struct BoundsFace {
  std::vector<Corner> corners;
  unsigned level = 0, kind = 0, page = 0;
};

/// Reads a PLY as its header says; the order of properties is that of the export.
std::vector<BoundsFace> read_bounds(const std::string& bytes) {
  std::istringstream header(bytes.substr(0, bytes.find("end_header\n")));
  std::size_t vertices = 0, faces = 0;
  for (std::string word; header >> word;) {
    if (word == "vertex") header >> vertices;
    if (word == "face") header >> faces;
  }
  std::size_t at = bytes.find("end_header\n") + 11;
  const auto take = [&]<class T>(T) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    at += sizeof value;
    return value;
  };
  std::vector<Corner> corners(vertices);
  for (Corner& corner : corners) {
    for (double& part : corner) part = take(0.0);
    at += 3;
  }
  std::vector<BoundsFace> found(faces);
  for (BoundsFace& face : found) {
    face.corners.resize(take(std::uint8_t{}));
    for (Corner& corner : face.corners) corner = corners.at(take(std::uint32_t{}));
    face.level = take(std::uint8_t{});
    face.kind = take(std::uint8_t{});
    face.page = take(std::uint32_t{});
  }
  EXPECT_EQ(at, bytes.size());
  return found;
}

Corner middle_of(const BoundsFace& face) {
  Corner sum{};
  for (const Corner& corner : face.corners)
    for (std::size_t i = 0; i < 3; ++i)
      sum[i] += corner[i] / static_cast<double>(face.corners.size());
  return sum;
}

Corner normal_of(const BoundsFace& face) {
  const Corner a = minus(face.corners[1], face.corners[0]);
  const Corner b = minus(face.corners[2], face.corners[0]);
  Corner n = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const double length = std::sqrt(dot(n, n));
  for (double& part : n) part /= length;
  return n;
}

// Whether a point is behind both polygons of a disc and within their corners' distance.
bool holds(const BoundsFace& lower, const BoundsFace& upper, const Corner& point) {
  constexpr double kSlack = 1e-5;
  const Corner from = minus(point, middle_of(upper)), normal = normal_of(upper);
  if (dot(from, normal) > kSlack) return false;
  if (dot(minus(point, middle_of(lower)), normal_of(lower)) > kSlack) return false;
  const double height = dot(from, normal);
  const Corner rim = minus(upper.corners[0], middle_of(upper));
  return dot(from, from) - height * height <= dot(rim, rim) + kSlack;
}

class BoundsFile : public Command {
 protected:
  Json export_level(int level) {
    const Outcome result = run({"inspect", "tree.ptree", "--export-bounds", std::to_string(level),
                                "bounds.ply", "--json", "--quiet", "--force"});
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output);
  }
};

TEST_F(BoundsFile, HasTheNodesOfTheLevelAndTheBlocksAbove) {
  const Json survey = Json::parse(run({"inspect", "tree.ptree", "--levels", "--json"}).output);
  std::uint64_t blocks_above = 0;
  const Json& levels = survey["by_level"];
  ASSERT_GT(levels.size(), 2u);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    const Json report = export_level(static_cast<int>(level));
    const std::uint64_t nodes = levels[level]["nodes"], blocks = levels[level]["blocks"];
    EXPECT_EQ(report["boxes"], level == 0 ? 1 : 0);
    EXPECT_EQ(report["node_discs"], level == 0 ? 0 : nodes);
    EXPECT_EQ(report["block_discs"], blocks + blocks_above);
    EXPECT_EQ(report["bytes"], fs::file_size("bounds.ply"));
    blocks_above += blocks;
    const auto faces = read_bounds(text_of("bounds.ply"));
    EXPECT_EQ(faces.size(), report["faces"]);
    for (const BoundsFace& face : faces) {
      EXPECT_EQ(face.corners.size(), face.kind == 2 ? 4u : 12u);
      EXPECT_LE(face.level, level);
      EXPECT_TRUE(face.level == level || face.kind == 1);
    }
  }
}

// Every vertex of the mesh is in a disc, at every level.
TEST_F(BoundsFile, EnclosesTheSurface) {
  for (const int level : {1, 2, 3, 9}) {
    export_level(level);
    const auto faces = read_bounds(text_of("bounds.ply"));
    ASSERT_EQ(faces.size() % 2, 0u);
    for (unsigned y = 0; y <= kSide; ++y)
      for (unsigned x = 0; x <= kSide; ++x) {
        const Corner vertex = {x + 0.0, y + 0.0, (x * 7 + y * 5) % 8 / 8.0};
        bool found = false;
        for (std::size_t i = 0; i < faces.size() && !found; i += 2)
          found = holds(faces[i], faces[i + 1], vertex);
        EXPECT_TRUE(found) << level << ": " << x << ' ' << y;
      }
  }
}

TEST_F(BoundsFile, WritesAMeshThatCanBeRead) {
  const Json report = export_level(2);
  const Outcome built = run({"build", "bounds.ply", "-o", "bounds.ptree", "--json", "--quiet"});
  ASSERT_EQ(built.status, 0) << built.errors;
  EXPECT_EQ(Json::parse(built.output)["triangles"], report["faces"].get<int>() * 10);
}

TEST_F(BoundsFile, RefusesWhatItCannotDo) {
  export_level(1);
  const auto expect_line = [](const std::vector<std::string>& more, int status,
                              const std::string& line) {
    std::vector<std::string> words = {"inspect", "tree.ptree", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome result = run(words);
    EXPECT_EQ(result.status, status) << result.errors;
    EXPECT_NE(result.errors.find(line), std::string::npos) << result.errors;
  };
  expect_line({"--export-bounds", "1", "bounds.ply"}, 2, "bounds.ply: ");
  expect_line({"--export-bounds", "1", "bounds.obj"}, 2, "'bounds.obj' is not a .ply");
  expect_line({"--export-bounds", "high", "b.ply"}, 2, "--export-bounds");
  expect_line({"--export-bounds", "300", "b.ply"}, 2, "300 is too large; give at most 255");
  expect_line({"--export-bounds", "1"}, 2, "--export-bounds");
  expect_line({"--force"}, 2, "--force replaces a file; add --image, --export-bounds or --html");
  expect_line({"--export-bounds", "1", "b.ply", "--page", "1"}, 2, "excludes");
  // Page 1 is read only for levels that are in it.
  flip("tree.ptree", entries_[1].offset);
  expect_line({"--export-bounds", "0", "b.ply"}, 0, "");
  expect_line({"--export-bounds", "9", "c.ply"}, 1, "tree.ptree: page 1: it cannot be read");
  EXPECT_FALSE(fs::exists("c.ply"));
}

}  // namespace
}  // namespace planetree::tools
