// Attributes of OBJ files.

#include <gtest/gtest.h>

#include <string>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

const std::string kPoints = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
const std::string kUvs = "vt 0.1 0.5\nvt 0.2\nvt 0.3 0.5 9\n";

/// Reads with much memory and with little, and expects the same.
Reading read_both(const std::string& bytes, std::uint32_t keep) {
  return read_kept_twice(bytes, ".obj", keep);
}

TEST(ObjAttributes, ColoursAreBehindThePositions) {
  const Reading reading = read_both(
      "v 0 0 0 0 0.5 1\nv 1 0 0 1 1 1 # white\nv 0 1 0 2 -1 nan\nf 1 2 3\nf 3 2 1\n", kKeepColor);
  EXPECT_EQ(reading.log,
            "0: 0 0 0, 1 0 0, 0 1 0\n  #0080ffff 0 0, #ffffffff 0 0, #ff0000ff 0 0, value 0\n"
            "1: 0 1 0, 1 0 0, 0 0 0\n  #ff0000ff 0 0, #ffffffff 0 0, #0080ffff 0 0, value 0\n");
}

TEST(ObjAttributes, ColoursAreOfAllVertices) {
  for (const char* const vertex : {"v 1 0 0", "v 1 0 0 1", "v 1 0 0 1 0.5", "v 1 0 0 1 1 1 1"}) {
    const std::string bytes =
        "v 0 0 0 0 0 0\n" + std::string(vertex) + "\nv 0 1 0 0 0 0\nf 1 2 3\n";
    EXPECT_EQ(read_both(bytes, 0).error, "");
    const Reading reading = read_both(bytes, kKeepColor);
    EXPECT_EQ(reading.code, ErrorCode::kBadInput);
    EXPECT_EQ(reading.error,
              "line 2: a vertex has no colour: it is not 'v x y z r g b'; build the mesh without "
              "--keep color");
  }
}

TEST(ObjAttributes, TextureCoordinatesAreThoseOfCorners) {
  const Reading reading = read_both(
      kPoints + kUvs + "f 1/3 2/2/7 3/1\nvt 0.4 0.5\nf 2/-1 4/-3/-1 3/-4\nf 1//1/ 2/3 4/2\n",
      kKeepUv);
  EXPECT_EQ(reading.log,
            "0: 0 0 0, 1 0 0, 0 1 0\n"
            "  #000000ff 0.300000012 0.5, #000000ff 0.200000003 0, #000000ff 0.100000001 0.5, "
            "value 0\n"
            "1: 1 0 0, 1 1 0, 0 1 0\n"
            "  #000000ff 0.400000006 0.5, #000000ff 0.200000003 0, #000000ff 0.100000001 0.5, "
            "value 0\n"
            "2: 0 0 0, 1 0 0, 1 1 0\n"
            "  #000000ff 0 0, #000000ff 0.300000012 0.5, #000000ff 0.200000003 0, value 0\n");
  EXPECT_EQ(notes_of(reading),
            "1 face with corners that name no texture vertex, the first in line 11, taken with "
            "zeros there\n");
}

TEST(ObjAttributes, TextureCoordinatesThatAreMissingDecideNothing) {
  const Reading reading =
      read_both(kPoints + kUvs + "f 1 2 3\nf 1/4 2/-9 3/0 4/1\nf 1/1 2/1 9/1\n", kKeepUv);
  EXPECT_EQ(reading.error, "");
  EXPECT_NE(reading.log.find("#000000ff 0 0, #000000ff 0 0, #000000ff 0 0, value 0\n"),
            std::string::npos);
  EXPECT_NE(reading.log.find("#000000ff 0.100000001 0.5"), std::string::npos);
  EXPECT_NE(reading.log.find("3+1 aside: line 10: "), std::string::npos) << reading.log;
  EXPECT_EQ(notes_of(reading),
            "2 faces with corners that name no texture vertex, the first in line 8, taken with "
            "zeros there\n");
}

TEST(ObjAttributes, FollowTheCornersOfAPolygon) {
  // Corner 2 is a dent, so that ears are cut.
  const Reading reading = read_both(
      "v 4 0 0\nv 4 4 0\nv 1 1 0\nv 0 4 0\nv 0 0 0\nvt 4 0\nvt 4 4\nvt 1 1\nvt 0 4\nvt 0 0\n"
      "f 1/1 2/2 3/3 4/4 5/5\n",
      kKeepUv);
  std::string expected;
  for (std::size_t at = 0; at < reading.log.size();) {
    std::string line = reading.log.substr(at, reading.log.find('\n', at) - at);
    at += line.size() + 1;
    if (line[0] == ' ') continue;
    // "0: 4 0 0, 4 4 0, 1 1 0" has the texture coordinates, with a third number.
    line = line.substr(line.find(": ") + 2) + ", ";
    std::string corners = "  ";
    for (std::size_t begin = 0; begin < line.size(); begin = line.find(", ", begin) + 2)
      corners += "#000000ff " + line.substr(begin, 3) + ", ";
    expected += corners + "value 0\n";
  }
  std::string found;
  for (std::size_t at = 0; at < reading.log.size();) {
    const std::string line = reading.log.substr(at, reading.log.find('\n', at) - at);
    at += line.size() + 1;
    if (line[0] == ' ') found += line + "\n";
  }
  EXPECT_EQ(found, expected);
  EXPECT_EQ(reading.summary->triangle_indices, 3u);
}

TEST(ObjAttributes, ThatAreMissingAreRefused) {
  const Reading uv = read_both(kPoints + "f 1/1 2/2 3/3\n", kKeepUv);
  EXPECT_EQ(uv.code, ErrorCode::kBadInput);
  EXPECT_EQ(uv.error,
            "no texture coordinates: no statement 'vt'; build the mesh without --keep uv");
  EXPECT_EQ(read_both(kPoints + "f 1 2 3\n", kKeepValue).error,
            "an OBJ has no values of triangles that are read; give a PLY for --keep value");
  for (const char* const bad : {"vt", "vt one", "vt 1 one"})
    EXPECT_EQ(read_both(kPoints + bad + "\nf 1/1 2/1 3/1\n", kKeepUv).code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace planetree::octree
