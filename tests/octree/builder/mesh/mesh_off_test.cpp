#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

const std::string kVertices = "0 0 0\n1 0 0\n0 1 0\n";
const std::string kBody = kVertices + "3 0 1 2\n";
const std::string kTriangle = "0: 0 0 0, 1 0 0, 0 1 0\n";

void expect_refused(const std::string& bytes, const std::string& message) {
  const Reading reading = read_bytes(bytes, ".off");
  EXPECT_FALSE(reading.summary) << message;
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_NE(reading.error.find(message), std::string::npos) << "said: " << reading.error;
}

TEST(OffAscii, ReadsVerticesInDoublePrecision) {
  const Reading reading = read_bytes("OFF\n3 1 3\n0.1 0 -0\n1 +2e0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log, "0: 0.10000000000000001 0 0, 1 2 0, 0 1 0\n");
  EXPECT_EQ(reading.summary->vertex_records, 3U);
  EXPECT_EQ(reading.summary->face_records, 1U);
  EXPECT_EQ(reading.summary->triangle_indices, 1U);
  EXPECT_FALSE(reading.summary->float32);
}

TEST(OffAscii, ReadsCountsInAnyHeaderLayout) {
  for (const std::string head :
       {"OFF\n3 1 0\n", "OFF 3 1 0\n", "OFF3 1 0\n", "  OFF\t\n\n 3 1 0 \n", "OFF\n3 1\n",
        "OFF 3 1\n", "OFF\n3 1 -7\n"})
    EXPECT_EQ(read_bytes(head + kBody).log, kTriangle) << head;
}

TEST(OffAscii, NeedsAKeywordOrTheExtension) {
  EXPECT_EQ(read_bytes("3 1 0\n" + kBody, ".off").log, kTriangle);
  EXPECT_EQ(read_bytes("# old\n3 1 0\n" + kBody, ".OFF").log, kTriangle);
  EXPECT_EQ(read_bytes("3 1 0\n" + kBody).code, ErrorCode::kBadInput);
  EXPECT_EQ(read_bytes("OFFER\n3 1 0\n" + kBody).code, ErrorCode::kBadInput);
}

TEST(OffAscii, SkipsOtherVertexProperties) {
  for (const std::string keyword : {"OFF", "COFF", "NOFF", "CNOFF", "STOFF", "STCNOFF", "NCSTOFF"})
    for (const std::string more : {"", " 255 0 0", " 0 0 1 255 0 0 255 0.5 0.5 # all"}) {
      std::string mesh = keyword + "\n3 1 0";
      for (const char* vertex : {"\n0 0 0", "\n1 0 0", "\n0 1 0"}) mesh.append(vertex).append(more);
      EXPECT_EQ(read_bytes(mesh + "\n3 0 1 2\n").log, kTriangle) << keyword << more;
    }
}

TEST(OffAscii, SkipsFaceColours) {
  EXPECT_EQ(read_bytes("OFF\n3 4 0\n" + kVertices +
                       "3 0 1 2 7\n3 0 1 2 255 0 0\n3 0 1 2 0.1 0.2 0.3 1\n3 0 1 2\n")
                .log,
            kTriangle + "1: 0 0 0, 1 0 0, 0 1 0\n2: 0 0 0, 1 0 0, 0 1 0\n3: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(OffAscii, SkipsCommentsAndEmptyLines) {
  const Reading reading = read_bytes(
      "\xEF\xBB\xBF# made by hand: OBJ\n\nOFF # a keyword\n# counts\n3 1 0# of edges\n\n"
      "0 0 0#0 1\n \t\n# 9 9 9\n1 0 0\n0 1 0 # the last\n3 0 1 2# 255\n# end\n\n");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log, kTriangle);
}

TEST(OffAscii, ReadsEveryKindOfLineEnd) {
  for (const std::string end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : "OFF\n3 1 0\n" + kBody) {
      if (c == '\n') {
        text += end;
      } else {
        text += c;
      }
    }
    EXPECT_EQ(read_bytes(text).log, kTriangle);
    EXPECT_EQ(read_bytes(text.substr(0, text.size() - end.size())).log, kTriangle);
  }
}

TEST(OffAscii, SplitsPolygonsIntoFans) {
  EXPECT_EQ(read_bytes("OFF\n5 2 0\n" + kVertices + "2 2 0\n3 3 0\n5 0 1 2 3 4\n3 2 1 0\n").log,
            "0: 0 0 0, 1 0 0, 0 1 0\n1: 0 0 0, 0 1 0, 2 2 0\n2: 0 0 0, 2 2 0, 3 3 0\n"
            "3: 0 1 0, 1 0 0, 0 0 0\n");
}

TEST(OffAscii, SkipsBadRecordsAsAWhole) {
  const Reading reading = read_bytes("OFF\n5 9 0\n" + kVertices + "nan 0 0\n0 0 -1.#IND\n" +
                                     "3 0 1 2\n4 0 1 2 3\n3 4 0 1\n5 0 1 2 5 1\n3 -1 0 1\n2 0 1\n" +
                                     "0\n3 0 1 99999999999999999999\n3 2 1 0\n");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log,
            "0: 0 0 0, 1 0 0, 0 1 0\n"
            "1+2 aside: face 1: vertex 3 is not finite\n"
            "3+1 aside: face 2: vertex 4 is not finite\n"
            "4+3 aside: face 3: vertex index 5 is out of range, the mesh has 5 vertices\n"
            "7+1 aside: face 4: vertex index -1 is out of range, the mesh has 5 vertices\n"
            "8+1 aside: face 5: has 2 corners, fewer than 3\n"
            "9+1 aside: face 6: has 0 corners, fewer than 3\n"
            "10+1 aside: face 7: vertex index 9223372036854775807 is out of range, the mesh has 5 "
            "vertices\n"
            "11: 0 1 0, 1 0 0, 0 0 0\n");
}

TEST(OffAscii, RefusesVerticesOfOtherDimensions) {
  expect_refused("4OFF\n3 1 0\n" + kBody,
                 "line 1: '4OFF' has vertices of other than three dimensions: write plain OFF; "
                 "copy or export the OFF again");
  expect_refused("# 4-d\nC4nOFF\n3\n3 1 0\n" + kBody, "line 2: 'C4nOFF' has vertices of other");
  expect_refused("nOFF BINARY\n", "line 1: 'nOFF' has vertices of other");
}

TEST(OffAscii, RefusesHeadersWithoutCounts) {
  expect_refused("\n", "line 2: the file ends in front of its counts");
  expect_refused("OFF", "line 2: the file ends in front of its counts");
  expect_refused("OFF\n# 3 1 0\n", "line 3: the file ends in front of its counts");
  for (const std::string counts : {"3", "3 x 0", "3 1.5 0", "-3 1 0", "3 -1 0", "3 1 x", "3 1 0 0"})
    expect_refused(std::string("OFF\n").append(counts).append("\n").append(kBody),
                   "line 2: '" + counts + "' is not the numbers of vertices, faces and edges");
  expect_refused("offer\n3 1 0\n", "line 1: 'offer' is not the numbers of vertices");
}

TEST(OffAscii, RefusesBodiesThatDoNotMatchTheCounts) {
  expect_refused("OFF\n4 0 0\n" + kVertices, "line 6: the file ends at record 3 of 4 'vertex'");
  expect_refused("OFF\n3 2 0\n" + kBody, "line 7: the file ends at record 1 of 2 'face'");
  expect_refused("OFF\n3 1 0\n" + kBody + "# more\n3 2 1 0\n",
                 "line 8: text follows the last record, so a count in the header is too small");
  expect_refused("OFF\n3 1 0\n0 0 0\n1 0 # 0\n0 1 0\n3 0 1 2\n",
                 "line 4: the line ends in front of 'z'");
  expect_refused("OFF\n3 1 0\n" + kVertices + "3 0 1\n",
                 "line 6: the file ends in front of 'corners'");
  expect_refused("OFF\n3 1 0\n" + kVertices + "3 0 1 2.5\n",
                 "line 6: '2.5' in 'corners' is not an integer");
  expect_refused("OFF\n3 1 0\n" + kVertices + "-3 0 1 2\n",
                 "line 6: list 'corners' has a negative length");
  expect_refused("OFF\n3 1 0\n0 zero 0\n", "line 3: 'zero' in 'y' is not a number");
}

// If the counts of vertices and faces are exchanged, the number of lines is the same.
TEST(OffAscii, RefusesFacesThatAreCountedAsVertices) {
  expect_refused(
      "OFF\n4 3 0\n" + kVertices + "3 0 1 2\n3 0 1 2\n3 0 1 2\n3 0 1 2\n",
      "line 6: a vertex of more or fewer numbers than the first, so a count in the header "
      "may be wrong");
}

TEST(OffAscii, WrongCountsCostNoMemory) {
  expect_refused("OFF\n18446744073709551615 1 0\n0 0 0\n",
                 "line 4: the file ends at record 1 of 9223372036854775807 'vertex'");
  expect_refused("OFF\n3 9223372036854775807 0\n" + kBody,
                 "line 7: the file ends at record 1 of 9223372036854775807 'face'");
}

TEST(OffAscii, RefusesAModelWithoutATriangle) {
  expect_refused("OFF\n3 0 0\n" + kVertices, "no triangle: the mesh has no faces");
  expect_refused("OFF\n0 1 0\n3 0 1 2\n",
                 "no triangle: all 1 face records are bad, first face 0: vertex index 0 is out of "
                 "range, the mesh has 0 vertices");
}

/// Counts and three vertices, each followed by `more_numbers` numbers, as its keyword requires.
Bytes binary_off(const std::string& head, std::int32_t face_count, int more_numbers = 0) {
  Bytes bytes(std::endian::big);
  bytes.text(head).put(std::int32_t{3}, face_count, std::int32_t{-1});
  const std::vector<float> corners[] = {{0.1F, 0, -0.0F}, {1, 0, 0}, {0, 1, 0}};
  for (const std::vector<float>& corner : corners) {
    bytes.put_all(corner);
    for (int i = 0; i < more_numbers; ++i) bytes.put(std::numeric_limits<float>::quiet_NaN());
  }
  return bytes;
}

using Int32 = std::int32_t;

TEST(OffBinary, ReadsEveryKeyword) {
  const std::pair<std::string, int> keywords[] = {{"OFF", 0},   {"COFF", 4},  {"NOFF", 3},
                                                  {"CNOFF", 7}, {"STOFF", 2}, {"STCNOFF", 9}};
  for (const auto& [keyword, more_numbers] : keywords) {
    for (const std::string end : {" BINARY\n", " BINARY # big-endian\n", "\tBINARY\r\n"}) {
      Bytes bytes = binary_off(keyword + end, 2, more_numbers);
      bytes.put(Int32{3}, Int32{0}, Int32{1}, Int32{2}, Int32{0});
      bytes.put(Int32{4}, Int32{2}, Int32{1}, Int32{0}, Int32{0}, Int32{4}, 1.0F, 0.5F, 0.25F,
                1.0F);
      const Reading reading = read_bytes(bytes.str());
      EXPECT_EQ(reading.error, "");
      EXPECT_EQ(reading.log,
                "0: 0.10000000149011612 0 0, 1 0 0, 0 1 0\n"
                "1: 0 1 0, 1 0 0, 0.10000000149011612 0 0\n"
                "2: 0 1 0, 0.10000000149011612 0 0, 0.10000000149011612 0 0\n");
      ASSERT_TRUE(reading.summary);
      EXPECT_EQ(reading.summary->vertex_records, 3U);
      EXPECT_TRUE(reading.summary->float32);
    }
  }
}

TEST(OffBinary, SkipsBadRecords) {
  Bytes bytes = binary_off("OFF BINARY\n", 4);
  bytes.put(Int32{3}, Int32{0}, Int32{1}, Int32{3}, Int32{0});
  bytes.put(Int32{3}, Int32{0}, Int32{1}, std::numeric_limits<Int32>::min(), Int32{0});
  bytes.put(Int32{1}, Int32{0}, Int32{1}, 0.5F);
  bytes.put(Int32{3}, Int32{2}, Int32{1}, Int32{0}, Int32{0});
  EXPECT_EQ(read_bytes(bytes.str()).log,
            "0+1 aside: face 0: vertex index 3 is out of range, the mesh has 3 vertices\n"
            "1+1 aside: face 1: vertex index -2147483648 is out of range, the mesh has 3 vertices\n"
            "2+1 aside: face 2: has 1 corners, fewer than 3\n"
            "3: 0 1 0, 1 0 0, 0.10000000149011612 0 0\n");
}

TEST(OffBinary, RefusesStructuralDamage) {
  Bytes whole = binary_off("OFF BINARY\n", 1);
  whole.put(Int32{3}, Int32{0}, Int32{1}, Int32{2}, Int32{0});
  ASSERT_TRUE(read_bytes(whole.str()).summary);
  expect_refused(whole.str() + "more", "byte 79: 4 bytes follow the last record");
  expect_refused("OFF BINARY 3 1 0\n" + kBody, "line 1: text follows 'BINARY'");
  expect_refused("OFF BINARY\n" + std::string(11, '\0'), "the file ends in front of its counts");
  const auto with_counts = [](Int32 vertices, Int32 faces) {
    return Bytes(std::endian::big).text("OFF BINARY\n").put(vertices, faces, Int32{0}).str();
  };
  expect_refused(with_counts(-1, 1), "line 2: a count of -1; copy or export the OFF again");
  expect_refused(with_counts(0, -2147483647 - 1), "line 2: a count of -2147483648");
  expect_refused(
      with_counts(2147483647, 1),
      "byte 23: 2147483647 records 'vertex' of 12 bytes or more do not fit in the 0 left");
  expect_refused(with_counts(0, 2147483647),
                 "byte 23: 2147483647 records 'face' of 8 bytes or more do not fit in the 0 left");
  Bytes negative = binary_off("OFF BINARY\n", 1);
  negative.put(Int32{-3}, Int32{0}, Int32{1}, Int32{2}, Int32{0});
  expect_refused(negative.str(), "record 0 of 1 'face' has a bad list length");
  Bytes with_colour_count = binary_off("OFF BINARY\n", 1);
  with_colour_count.put(Int32{3}, Int32{0}, Int32{1}, Int32{2}, Int32{2147483647});
  expect_refused(with_colour_count.str(),
                 "record 0 of 1 'face' has a bad list length or is cut off");
}

}  // namespace
}  // namespace planetree::octree
