#include "tools/points/row_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/tools/points/points_fixture.h"
#include "tools/cli/input_file.h"

namespace planetree::tools {
namespace {

TEST_F(Points, ReadCsvInAllItsForms) {
  const std::vector<std::vector<double>> expected = {{1, 2, 3}, {-4, 5.5, 6e3}, {7, 8, 9}};
  expect_points(read("a.csv", "1,2,3\n-4,5.5,6e3\n7,8,9\n"), expected);
  expect_points(read("b.csv",
                     "\xef\xbb\xbf"
                     "1,2,3\r\n-4,5.5,6e3\r\n\r\n7,8,9"),
                expected);
  expect_points(read("c.csv", "x,y,z\n 1 ,\t2,3,red\n-4,5.5,6e3,,\n\"7\",8,9,x,y\n"), expected);
  expect_points(read("d.txt", "name,Z,Y,X\na,3,2,1\nb,6e3,5.5,-4\nc,9,8,7\n"), expected);
  expect_points(read("e.csv", "east,north,up\n1,2,3\n-4,5.5,6e3\n7,8,9\n"), expected);
  expect_points(read("f.csv", ""), {});
  expect_points(read("g.csv", "x,y,z"), {});
}

TEST_F(Points, PassOnNonFiniteNumbers) {
  const Reading reading = read("a.csv", "nan,NaN,inf\n-inf,1e999,0\n");
  ASSERT_EQ(reading.points.size(), 2u);
  EXPECT_TRUE(std::isnan(reading.points[0].x));
  EXPECT_EQ(reading.points[1].y, HUGE_VAL);
}

TEST_F(Points, ErrorsNameTheLine) {
  EXPECT_EQ(read("a.csv", "1,2,3\n\n1,2,\n").error,
            "line 3: '' is not a number; give x,y,z, one point a line");
  EXPECT_EQ(read("b.csv", "1,2,x\n").error,
            "line 1: 'x' is not a number; give x,y,z, one point a line");
  EXPECT_EQ(read("c.csv", "1,2,3\na\n").error,
            "line 2: 'a' is not a number; give x,y,z, one point a line");
  EXPECT_EQ(read("d.csv", "1,2,3\n4 5 6\n").error,
            "line 2: '4 5 6' is not a number; give x,y,z, one point a line");
  const std::string long_line(LineReader::kMaxLineBytes + 1, '1');
  EXPECT_EQ(read("e.csv", "1,2,3\n" + long_line + "\n").error,
            "line 2 is longer than 65536 bytes; give one point a line");
}

TEST_F(Points, DeliverThePointsBeforeAnError) {
  for (const std::size_t piece : {1u, 2u, 3u, 4u, 100u}) {
    const Reading reading = read("a.csv", "1,2,3\n4,5,6\n7,8,9\nx,0,0\n1,1,1\n", piece);
    EXPECT_EQ(reading.points.size(), 3u);
    EXPECT_FALSE(reading.error.empty());
  }
}

TEST_F(Points, ReadLinesAcrossBuffers) {
  std::string text;
  std::vector<std::vector<double>> expected;
  for (int i = 0; i < 30000; ++i) {
    text += std::to_string(i) + ",0," + std::to_string(2 * i) + "\n";
    expected.push_back({static_cast<double>(i), 0, static_cast<double>(2 * i)});
  }
  expect_points(read("a.csv", text, 1000), expected);
}

TEST_F(Points, ReadRawTriples) {
  const double values[] = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  const std::string bytes(reinterpret_cast<const char*>(values), sizeof values);
  expect_points(read("a.F64", bytes), {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  const Reading cut = read("b.f64", bytes.substr(0, 60));
  EXPECT_EQ(cut.points.size(), 2u);
  EXPECT_EQ(cut.error, "the file ends 12 bytes into a point of 24 bytes; write whole points");
}

TEST_F(Points, ReadPlyWithAndWithoutFaces) {
  const std::string vertices =
      "element vertex 2\nproperty float x\nproperty float y\nproperty uchar red\nproperty float "
      "z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  for (const std::string& more : {std::string(), faces}) {
    expect_points(read("a.ply", "ply\nformat ascii 1.0\ncomment c\n" + vertices + more +
                                    "end_header\n0.1 2 255 3\n4 5 0 6\n3 0 1 0\n"),
                  {{0.1f, 2, 3}, {4, 5, 6}});
  }
  const std::string plain =
      "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n";
  for (const bool swap : {false, true}) {
    const std::string format =
        std::string("ply\nformat binary_") + (swap ? "big" : "little") + "_endian 1.0\n";
    expect_points(
        read("b.ply", binary_ply(format + plain + "end_header\n", {1, 2, 3, 4, 5, 6}, swap)),
        {{1, 2, 3}, {4, 5, 6}});
    expect_points(read("c.ply", binary_ply(format + "element camera 1\nproperty float f\n" + plain +
                                               "end_header\n",
                                           {9, 1, 2, 3, 4, 5, 6}, swap)),
                  {{1, 2, 3}, {4, 5, 6}});
  }
}

TEST_F(Points, RefuseDamagedPly) {
  const std::string ascii =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  const Reading short_file = read("a.ply", ascii + "1 2 3\n4 5 6\n");
  EXPECT_EQ(short_file.points.size(), 2u);
  EXPECT_NE(short_file.error.find("ends before its last vertex"), std::string::npos);
  const Reading bad = read("b.ply", ascii + "1 2 3\n4 five 6\n7 8 9\n", 1);
  EXPECT_EQ(bad.points.size(), 1u);
  EXPECT_EQ(bad.error.substr(0, 8), "line 9: ");
  EXPECT_FALSE(read("c.ply", "ply\nformat ascii 1.0\nend_header\n").error.empty());
  EXPECT_FALSE(read("d.ply", "ply\nformat ascii 1.0\n").error.empty());
  const std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 99999999999999999\nproperty float "
      "x\nproperty float y\nproperty float z\nend_header\n";
  EXPECT_NE(read("e.ply", binary + "123").error.find("middle of its"), std::string::npos);
}

TEST_F(Points, ReadStandardInputAsAFile) {
  expect_points(read_input("1 2 3\n4 5 6\n"), {{1, 2, 3}, {4, 5, 6}});
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty "
      "double z\nend_header\n1 2 3\n";
  expect_points(read_input(ply), {{1, 2, 3}});
  EXPECT_EQ(read_input(ply.substr(0, ply.size() - 3)).error.substr(0, 8), "line 8: ");
  EXPECT_NE(read_input("\x1f\x8b\x08").error.find("gzip"), std::string::npos);
}

TEST_F(Points, RefuseColumnsOfWhatIsNoText) {
  EXPECT_NE(read("a.f64", std::string(24, '\0'), 2, "1,2,3").error.find("--columns"),
            std::string::npos);
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\nproperty "
      "double z\nend_header\n1 2 3\n";
  EXPECT_NE(read("a.ply", ply, 2, "1,2,3").error.find("--columns"), std::string::npos);
}

TEST_F(Points, RefuseMissingFilesAndDirectories) {
  EXPECT_FALSE(open_points((folder_ / "none").string(), stdin));
  const auto folder = open_points((folder_ / ".").string(), stdin);
  Vec3 point;
  EXPECT_TRUE(!folder || !(*folder)->read(std::span(&point, 1)));
}

}  // namespace
}  // namespace planetree::tools
