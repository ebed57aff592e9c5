#include "tools/points/foreign_format.h"

#include <string>
#include <utility>
#include <vector>

#include "tests/tools/points/points_fixture.h"

namespace planetree::tools {
namespace {

using namespace std::string_literals;

/// A binary STL with one facet.
std::string binary_stl() {
  std::string bytes(80, ' ');
  bytes += "\1\0\0\0"s;
  return bytes + std::string(50, '\0');
}

std::string utf16(const std::string& text, bool big_endian) {
  std::string wide;
  for (const char c : text) wide += big_endian ? "\0"s + c : c + "\0"s;
  return wide;
}

TEST_F(Points, NameTheFormatTheyRefuse) {
  const std::vector<std::pair<std::string, const char*>> cases = {
      {"# .PCD v0.7 - Point Cloud Data\nVERSION 0.7\nFIELDS x y z\n1 2 3\n", "a PCD point cloud"},
      {"VERSION .7\nFIELDS x y z\nPOINTS 1\nDATA ascii\n1 2 3\n", "a PCD point cloud"},
      {"LASF\0\0\0\0\1\2"s, "its LAS header"},
      {"ASTM-E57\1\0\0\0"s, "an E57 point cloud"},
      {binary_stl(), "a binary STL mesh"},
      {"solid a\n facet normal 0 0 1\n  outer loop\n   vertex 1 2 3\n", "an STL mesh"},
      {"glTF\2\0\0\0"s, "a binary glTF"},
      {"v 1 2 3\nv 4 5 6\nv 7 8 9\nf 1 2 3\n", "an OBJ mesh"},
      {"mtllib a.mtl\no a\nv 1 2 3\n", "an OBJ mesh"},
      {"OFF\n3 1 0\n1 2 3\n4 5 6\n7 8 9\n3 0 1 2\n", "an OFF mesh"},
      {"2\n1\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 2 3 0.5\n4 5 6 0.5\n", "a PTX scan"},
      {"PK\3\4\24\0"s, "a ZIP archive"},
      {"\x1f\x8b\x08\0"s, "gzip"},
      {"\x28\xb5\x2f\xfd\x04\0"s, "zstd"},
      {"\xfd"
       "7zXZ\0"s,
       "xz"},
      {"BZh91AY", "bzip2"},
      {"\xff\xfe" + utf16("1,2,3\n", false), "UTF-16"},
      {"\xfe\xff" + utf16("1,2,3\n", true), "UTF-16"},
      {utf16("x,y,z\n1,2,3\n", false), "UTF-16"},
      {utf16("x,y,z\n1,2,3\n", true), "UTF-16"},
      {"\x89PTREE\r\n\x1a\n", "a .ptree file"},
      {"\x93NUMPY\1\0v\0{'descr'"s, "the NumPy array"},
      {"{\"points\": [[1,2,3]]}\n", "JSON"},
      {"<?xml version=\"1.0\"?>\n<VTKFile>\n", "XML"},
      {"1,2,3\n4,5\x01,6\n", "this is binary data"}};
  for (const auto& [text, name] : cases) {
    const Reading reading = read("points.csv", text);
    EXPECT_TRUE(reading.points.empty()) << name;
    EXPECT_NE(reading.error.find(name), std::string::npos) << name << ": " << reading.error;
    EXPECT_NE(reading.error.find("; "), std::string::npos) << name;
    EXPECT_EQ(read_input(text).error, reading.error) << name;
  }
}

TEST_F(Points, NeverFindPointsInRandomBytes) {
  std::uint32_t state = 1;
  for (int round = 0; round < 200; ++round) {
    std::string bytes;
    for (int i = 0; i < round; ++i) {
      state = state * 1664525 + 1013904223;
      bytes += static_cast<char>(state >> 24);
    }
    EXPECT_TRUE(read("random.bin", bytes).points.empty()) << round;
  }
}

TEST_F(Points, MistakeNoTextForAnotherFormat) {
  const std::vector<std::vector<double>> one = {{1, 2, 3}};
  expect_points(read("a.csv", "solid,x,y,z\n7,1,2,3\n"), one);
  expect_points(read("b.csv", "fields,x,y,z\n7,1,2,3\n"), one);
  expect_points(read("c.csv", "name,x,y,z\n\xc3\xa9t\xc3\xa9,1,2,3\n"), one);
  expect_points(read("d.csv", "name,x,y,z\n\xe9t\xe9,1,2,3\n"), one);
  expect_points(read("e.csv", "<x>,y,z\n1,2,3\n", 2, "1,2,3"), one);
}

}  // namespace
}  // namespace planetree::tools
