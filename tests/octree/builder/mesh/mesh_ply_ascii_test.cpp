#include <gtest/gtest.h>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

const std::string kFloatVertices = "property float x\nproperty float y\nproperty float z\n";
const std::string kFaceList = "property list uchar int vertex_indices\n";

/// An ascii PLY with float vertices.
std::string ascii_ply(int vertex_count, int face_count, const std::string& body) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertex_count) + "\n" +
         kFloatVertices + "element face " + std::to_string(face_count) + "\n" + kFaceList +
         "end_header\n" + body;
}

TEST(PlyAscii, ReadsOneTriangle) {
  const Reading reading = read_bytes(ascii_ply(3, 1, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log, "0: 0 0 0, 1 0 0, 0 1 0\n");
  ASSERT_TRUE(reading.summary);
  EXPECT_EQ(reading.summary->vertex_records, 3U);
  EXPECT_EQ(reading.summary->face_records, 1U);
  EXPECT_EQ(reading.summary->triangle_indices, 1U);
  EXPECT_TRUE(reading.summary->float32);
}

TEST(PlyAscii, NeedsNoLastNewline) {
  EXPECT_EQ(read_bytes(ascii_ply(3, 1, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2")).log,
            "0: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(PlyAscii, SplitsPolygonsIntoFans) {
  const Reading reading = read_bytes(
      ascii_ply(5, 3, "0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n3 0 1 2\n5 4 3 2 1 0\n4 0 1 2 3\n"));
  EXPECT_EQ(reading.log,
            "0: 0 0 0, 1 0 0, 2 1 0\n"
            "1: 0 1 0, 1 2 0, 2 1 0\n"
            "2: 0 1 0, 2 1 0, 1 0 0\n"
            "3: 0 1 0, 1 0 0, 0 0 0\n"
            "4: 0 0 0, 1 0 0, 2 1 0\n"
            "5: 0 0 0, 2 1 0, 1 2 0\n");
  EXPECT_EQ(reading.summary->triangle_indices, 6U);
  EXPECT_EQ(reading.summary->face_records, 3U);
}

TEST(PlyAscii, SkipsBadRecordsAsAWhole) {
  const Reading reading = read_bytes(ascii_ply(5, 8,
                                               "0 0 0\n1 0 0\n0 1 0\nnan 0 0\n0 0 1e39\n"
                                               "3 0 1 2\n"
                                               "5 0 1 2 3 0\n"  // vertex 3 is not finite
                                               "3 0 1 4\n"      // too large for the float declared
                                               "4 0 1 2 5\n"    // out of range
                                               "3 -1 0 1\n"     // negative
                                               "2 0 1\n"        // too few
                                               "0\n"            // none
                                               "3 2 1 0\n"));
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log,
            "0: 0 0 0, 1 0 0, 0 1 0\n"
            "1+3 aside: face 1: vertex 3 is not finite\n"
            "4+1 aside: face 2: vertex 4 is not finite\n"
            "5+2 aside: face 3: vertex index 5 is out of range, the mesh has 5 vertices\n"
            "7+1 aside: face 4: vertex index -1 is out of range, the mesh has 5 vertices\n"
            "8+1 aside: face 5: has 2 corners, fewer than 3\n"
            "9+1 aside: face 6: has 0 corners, fewer than 3\n"
            "10: 0 1 0, 1 0 0, 0 0 0\n");
  EXPECT_EQ(reading.summary->face_records, 8U);
  EXPECT_EQ(reading.summary->triangle_indices, 11U);
}

TEST(PlyAscii, IgnoresBadVerticesThatNoFaceUses) {
  EXPECT_EQ(read_bytes(ascii_ply(4, 1, "0 0 0\ninf nan 0\n1 0 0\n0 1 0\n3 0 2 3\n")).log,
            "0: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(PlyAscii, DeliversTrianglesWithoutArea) {
  EXPECT_EQ(read_bytes(ascii_ply(3, 2, "0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n3 1 1 1\n")).log,
            "0: 0 0 0, 1 0 0, 2 0 0\n1: 1 0 0, 1 0 0, 1 0 0\n");
}

TEST(PlyAscii, DeliversNegativeZeroAsZero) {
  EXPECT_EQ(read_bytes(ascii_ply(3, 1, "-0 -0.0 -1e-60\n1 -0 0\n0 1 -0\n3 0 1 2\n")).log,
            "0: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(PlyAscii, ReadsCoordinatesInTheDeclaredPrecision) {
  const std::string body = "0.1 0.1 0.1\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_EQ(read_bytes(ascii_ply(3, 1, body)).log,
            "0: 0.10000000149011612 0.10000000149011612 0.10000000149011612, 1 0 0, 0 1 0\n");
  const Reading mixed = read_bytes(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty float y\n"
      "property uint z\nelement face 1\n" +
      kFaceList + "end_header\n0.1 0.1 4294967295\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(mixed.log, "0: 0.10000000000000001 0.10000000149011612 4294967295, 1 0 0, 0 1 0\n");
  EXPECT_FALSE(mixed.summary->float32);
}

TEST(PlyAscii, FindsPropertiesInAnyOrderAmongOthers) {
  const Reading reading = read_bytes(
      "ply\nformat ascii 1.0\ncomment element vertex 99\nobj_info none\n"
      "element camera 2\nproperty float focus\nproperty list uchar float lens\n"
      "element vertex 3\nproperty uchar red\nproperty float z\nproperty list uint short tags\n"
      "property float x\nproperty float nx\nproperty float y\n"
      "element edge 1\nproperty int vertex1\nproperty int vertex2\nelement nothing 3\n"
      "element face 1\nproperty list uchar float texcoord\nproperty int material\n"
      "property list ushort uint vertex_index\nproperty uchar flags\n"
      "element tail 1\nproperty list int int items\nend_header\n"
      "1.5 2 0.1 0.2\n1.5 0\n"
      "255 3 2 7 8 1 9 2\n"
      "255 6 0 4 9 5\n"
      "\n"
      "255 0 1 7 0 9 0\n"
      "0 1\n"
      "2 0.5 0.5 7 3 0 1 2 1\n"
      "3 1 2 3\n\n");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log, "0: 1 2 3, 4 5 6, 0 0 0\n");
}

TEST(PlyAscii, ReadsFacesInFrontOfVertices) {
  const Reading reading =
      read_bytes("ply\nformat ascii 1.0\nelement face 2\n" + kFaceList + "element vertex 3\n" +
                 kFloatVertices + "end_header\n3 0 1 2\n3 0 1 3\n0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log,
            "0: 0 0 0, 1 0 0, 0 1 0\n"
            "1+1 aside: face 1: vertex index 3 is out of range, the mesh has 3 vertices\n");
}

TEST(PlyAscii, ReadsEveryKindOfLineEnd) {
  const std::string unix_text = ascii_ply(3, 1, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  for (const std::string end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : unix_text) {
      if (c == '\n') {
        text += end;
      } else {
        text += c;
      }
    }
    const Reading reading = read_bytes(text);
    EXPECT_EQ(reading.error, "");
    EXPECT_EQ(reading.log, "0: 0 0 0, 1 0 0, 0 1 0\n");
  }
}

void expect_refused(const std::string& text, const std::string& message) {
  const Reading reading = read_bytes(text);
  EXPECT_FALSE(reading.summary) << message;
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_NE(reading.error.find(message), std::string::npos) << "said: " << reading.error;
}

TEST(PlyAscii, RefusesBodiesThatDoNotMatchTheHeader) {
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  expect_refused(ascii_ply(4, 0, vertices), "line 13: the file ends at record 3 of 4 'vertex'");
  expect_refused(ascii_ply(3, 2, vertices + "3 0 1 2\n"),
                 "line 14: the file ends at record 1 of 2 'face'");
  expect_refused(ascii_ply(3, 1, "0 0 0\n1 0\n0 1 0\n3 0 1 2\n"),
                 "line 11: the line ends in front of 'z'");
  expect_refused(ascii_ply(3, 1, "0 0 0\n1 0 0 0\n0 1 0\n3 0 1 2\n"),
                 "line 11: '0' follows the last declared value");
  expect_refused(ascii_ply(3, 1, "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n"),
                 "line 11: 'zero' in 'y' is not a number");
  expect_refused(ascii_ply(3, 1, vertices + "3 0 1\n"),
                 "line 13: the file ends in front of 'vertex_indices'");
  expect_refused(ascii_ply(3, 1, vertices + "3 0 1 2 0\n"),
                 "line 13: '0' follows the last declared value");
  expect_refused(ascii_ply(3, 1, vertices + "3 0 1 2.5\n"),
                 "line 13: '2.5' in 'vertex_indices' is not an integer");
  expect_refused(ascii_ply(3, 1, vertices + "-1 0 1 2\n"),
                 "line 13: list 'vertex_indices' has a negative length");
  expect_refused(ascii_ply(3, 1, vertices + "999999999999999999999 0 1 2\n"),
                 "line 13: the file ends in front of 'vertex_indices'");
  expect_refused(ascii_ply(3, 1, vertices + "3 0 1 2\n\n3 2 1 0\n"),
                 "line 15: text follows the last record");
}

TEST(PlyAscii, WrongCountsCostNoMemory) {
  std::string text = ascii_ply(3, 1, "0 0 0\n");
  text.replace(text.find("vertex 3"), 8, "vertex 18446744073709551615");
  expect_refused(text, "line 11: the file ends at record 1 of 9223372036854775807 'vertex'");
}

TEST(PlyAscii, RefusesAModelWithoutATriangle) {
  expect_refused(ascii_ply(3, 0, "0 0 0\n1 0 0\n0 1 0\n"), "no triangle: the mesh has no faces");
  expect_refused(ascii_ply(1, 2, "0 0 0\n1 0\n3 0 0 1\n"),
                 "no triangle: all 2 face records are bad, first face 0: has 1 corners");
}

}  // namespace
}  // namespace planetree::octree
