#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

Bytes binary_stl(const std::string& title, std::uint32_t count) {
  Bytes bytes;
  bytes.text(title + std::string(80 - title.size(), '\0')).put(count);
  return bytes;
}

void put_facet(Bytes& bytes, const std::vector<float>& corners) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  bytes.put(nan, nan, nan).put_all(corners).put(std::uint16_t{0xffff});
}

const std::vector<float> kCorners = {0, 0, 0, 1, 0, 0, 0, 1, -0.0F};
const std::string kFacet =
    "facet normal nan 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 -0\nendloop\n"
    "endfacet\n";

void expect_refused(const std::string& bytes, const std::string& message,
                    const std::string& extension = ".stl") {
  const Reading reading = read_bytes(bytes, extension);
  EXPECT_FALSE(reading.summary) << message;
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_NE(reading.error.find(message), std::string::npos) << "said: " << reading.error;
}

TEST(StlBinary, IgnoresNormals) {
  Bytes bytes = binary_stl("made by hand", 2);
  put_facet(bytes, kCorners);
  put_facet(bytes, {0.1F, 0, 0, 0, 2, 0, 0, 0, 3});
  const Reading reading = read_bytes(bytes.str());
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log, "0: 0 0 0, 1 0 0, 0 1 0\n1: 0.10000000149011612 0 0, 0 2 0, 0 0 3\n");
  EXPECT_EQ(reading.summary->vertex_records, 6U);
  EXPECT_EQ(reading.summary->face_records, 2U);
  EXPECT_EQ(reading.summary->triangle_indices, 2U);
  EXPECT_TRUE(reading.summary->float32);
}

TEST(StlBinary, IsDetectedByItsSizeDespiteTheWordSolid) {
  Bytes bytes = binary_stl("solid but binary" + std::string(64, ' '), 0x01010101);
  // A count without a zero byte would need gigabytes of facets, so only a wrong size is tested.
  EXPECT_FALSE(read_bytes(bytes.str()).summary);
  bytes = binary_stl("solid but binary", 1);
  put_facet(bytes, kCorners);
  EXPECT_EQ(read_bytes(bytes.str()).log, "0: 0 0 0, 1 0 0, 0 1 0\n");
  // The zero bytes of a count identify a binary file even if its size is wrong.
  expect_refused(bytes.str() + std::string(50, 'x'), "the count is 1 facets");
}

TEST(StlBinary, SkipsBadFacets) {
  Bytes bytes = binary_stl("", 3);
  put_facet(bytes, kCorners);
  put_facet(bytes, {0, 0, 0, 1, std::numeric_limits<float>::infinity(), 0, 0, 1, 0});
  put_facet(bytes, kCorners);
  EXPECT_EQ(read_bytes(bytes.str()).log,
            "0: 0 0 0, 1 0 0, 0 1 0\n"
            "1+1 aside: facet 1: corner 1 is not finite\n"
            "2: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(StlBinary, RefusesWrongCounts) {
  Bytes bytes = binary_stl("", 2);
  put_facet(bytes, kCorners);
  expect_refused(bytes.str(),
                 "byte 80: the count is 2 facets, the file has bytes for 1: it is "
                 "truncated; copy or export it again");
  expect_refused(bytes.str() + std::string(49, 'x'), "has bytes for 1: it is truncated");
  Bytes more = binary_stl("", 4294967295);
  put_facet(more, kCorners);
  expect_refused(more.str(), "the count is 4294967295 facets, the file has bytes for 1");
  Bytes fewer = binary_stl("", 0);
  put_facet(fewer, kCorners);
  expect_refused(fewer.str(),
                 "the count is 0 facets, the file has bytes for 1: the count is wrong");
  expect_refused(std::string(83, 'x'), "byte 83: the file ends within the 84 bytes");
  expect_refused(binary_stl("", 0).str(), "no triangle: the mesh has no faces");
}

TEST(StlAscii, ReadsFacetsInDoublePrecision) {
  const Reading reading =
      read_bytes("solid a name of many words\n" + kFacet +
                 "  FACET NORMAL 0 0 1\n\tOuter Loop\n Vertex 0.1 +2e0 -3.5\n vertex 4 5 6\n\n"
                 " vertex 7 8 9\n  endloop\n endfacet\nendsolid a name of many words\n");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log, "0: 0 0 0, 1 0 0, 0 1 0\n1: 0.10000000000000001 2 -3.5, 4 5 6, 7 8 9\n");
  EXPECT_EQ(reading.summary->vertex_records, 6U);
  EXPECT_FALSE(reading.summary->float32);
}

TEST(StlAscii, ReadsSeveralSolidsAndEveryKindOfLineEnd) {
  const std::string solid = "solid\n" + kFacet + "endsolid\n";
  for (const std::string end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : "\n" + solid + solid) {
      if (c == '\n') {
        text += end;
      } else {
        text += c;
      }
    }
    const Reading reading = read_bytes(text);
    EXPECT_EQ(reading.error, "");
    EXPECT_EQ(reading.log, "0: 0 0 0, 1 0 0, 0 1 0\n1: 0 0 0, 1 0 0, 0 1 0\n");
  }
}

TEST(StlAscii, SkipsBadFacetsAndSplitsPolygons) {
  const Reading reading = read_bytes(
      "solid s\n"
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n"
      "facet normal 0 0 1\nendfacet\n"
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n"
      "endloop\nendfacet\n"
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 nan 0\n"
      "endloop\nendfacet\n" +
      kFacet + "endsolid s\n");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log,
            "0+1 aside: facet 0: has 2 corners, fewer than 3\n"
            "1+1 aside: facet 1: has 0 corners, fewer than 3\n"
            "2: 0 0 0, 1 0 0, 1 1 0\n"
            "3: 0 0 0, 1 1 0, 0 1 0\n"
            "4+2 aside: facet 3: corner 3 is not finite\n"
            "6: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(StlAscii, RefusesStructuralDamage) {
  expect_refused("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
                 "line 5: the file ends within a facet: it is truncated");
  expect_refused("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n",
                 "line 4: a vertex of fewer than three numbers");
  expect_refused("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0 0\n",
                 "line 4: a vertex of more than three numbers");
  expect_refused("solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 o 0\n",
                 "line 4: 'o' is not a number");
  expect_refused("solid s\nvertex 0 0 0\n", "line 2: 'vertex' is not expected here");
  expect_refused("solid s\nfacet normal 0 0 1\nfacet\n", "line 3: 'facet' is not expected here");
  expect_refused("solid s\nfacet normal 0 0 1\nouter loop\nendsolid\n",
                 "line 4: 'endsolid' is not expected here");
  expect_refused("solid s\nfacet normal 0 0 1\nouter loop\nendloop\nouter loop\n",
                 "line 5: a facet with a second loop");
  expect_refused("solid s\nendsolid\nfacet\n", "line 3: 'facet' is not expected here");
  expect_refused("solid s\nendsolid s\n", "no triangle: the mesh has no faces");
}

}  // namespace
}  // namespace planetree::octree
