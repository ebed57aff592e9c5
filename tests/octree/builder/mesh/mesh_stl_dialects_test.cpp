// STL files as programs write them beside the rules.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

const std::string kTriangle = "0: 0 0 0, 1 0 0, 0 1 0\n";
const std::string kTwoTriangles = kTriangle + "1: 1 0 0, 1 1 0, 0 1 0\n";

void expect_refused(const std::string& bytes, const std::string& message) {
  const Reading reading = read_bytes(bytes, ".stl");
  EXPECT_FALSE(reading.summary) << message;
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_NE(reading.error.find(message), std::string::npos) << "said: " << reading.error;
}

void expect_read(const std::string& bytes, const std::string& log, const std::string& notes) {
  const Reading reading = read_bytes(bytes, ".stl");
  EXPECT_EQ(reading.error, "") << bytes;
  EXPECT_EQ(reading.log, log) << bytes;
  EXPECT_EQ(notes_of(reading), notes) << bytes;
}

Bytes& put_facet(Bytes& bytes, const std::vector<float>& corners, std::uint16_t attribute) {
  return bytes.put(0.0F, 0.0F, 1.0F).put_all(corners).put(attribute);
}

/// Two facets, each with an attribute and that many bytes `payload`, if it is not empty.
Bytes two_facets(std::uint32_t count, std::uint16_t attribute, const std::string& payload) {
  Bytes bytes;
  bytes.text(std::string(80, '\0')).put(count);
  put_facet(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0}, attribute).text(payload);
  put_facet(bytes, {1, 0, 0, 1, 1, 0, 0, 1, 0}, attribute).text(payload);
  return bytes;
}

TEST(StlBinaryDialect, KeepsColoursInAttributes) {
  for (const int attribute : {0, 5, 0x7fff, 0x8000, 0xffff})
    expect_read(two_facets(2, static_cast<std::uint16_t>(attribute), "").str(), kTwoTriangles, "");
}

TEST(StlBinaryDialect, NotesHarmlessBytesBehindTheLastFacet) {
  for (const std::string& surplus :
       {std::string(1, '\0'), std::string(49, '\0'), std::string("\r\n"), std::string(50, '\0'),
        std::string(4000, '\0'), std::string("\x1a")}) {
    const std::string note =
        std::to_string(surplus.size()) +
        " zero or blank bytes behind the last facet are not read; if facets are "
        "missing, copy or export the file again\n";
    expect_read(two_facets(2, 0, "").str() + surplus, kTwoTriangles, note);
  }
}

TEST(StlBinaryDialect, RefusesOtherBytesBehindTheLastFacet) {
  for (const std::string surplus :
       {"x", "\1\0", "some text of a program", "                   .   "})
    expect_refused(two_facets(2, 0, "").str() + surplus,
                   "byte 184: " + std::to_string(surplus.size()) +
                       " bytes follow the last of 2 facets, and fit no attributes");
  expect_refused(two_facets(2, 0, "").str() + std::string(50, 'x'),
                 "has bytes for 3: the count is wrong");
}

TEST(StlBinaryDialect, StepsOverPayloadsThatFillTheFile) {
  for (const std::string& payload :
       {std::string("rgb"), std::string(2, '\0'), std::string(60, 'p')})
    expect_read(two_facets(2, static_cast<std::uint16_t>(payload.size()), payload).str(),
                kTwoTriangles, "");
}

TEST(StlBinaryDialect, RefusesPayloadsThatDoNotFillTheFile) {
  expect_refused(two_facets(2, 3, "rgba").str(), "byte 184: 8 bytes follow the last of 2 facets");
  expect_refused(two_facets(2, 4, "rgb").str(), "byte 184: 6 bytes follow the last of 2 facets");
  expect_refused(two_facets(2, 25, std::string(25, 'p')).str() + "p",
                 "has bytes for 3: the count is wrong");
}

const std::string kCorners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
const std::string kFacet = "facet normal 0 0 1\nouter loop\n" + kCorners + "endloop\nendfacet\n";

TEST(StlAsciiDialect, ReadsEndAsAWordOfItsOwn) {
  const std::string begin = "facet normal 0 0 1\nouter loop\n" + kCorners;
  for (const std::string end :
       {"end loop\nendfacet\nendsolid\n", "endloop\nend facet\nendsolid\n",
        "endloop\nendfacet\nend solid\n", "END  LOOP\nEnd\tFacet\nEND SOLID x\n",
        "end loop\nend facet\nend solid of three words"})
    expect_read("solid\n" + begin + end, kTriangle, "");
}

TEST(StlAsciiDialect, ReadsKeywordsInAnyCase) {
  for (const std::string text :
       {"SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 "
        "0\nENDLOOP\n"
        "ENDFACET\nENDSOLID A\n",
        "Solid\nFacet Normal 0 0 1\nOuter Loop\nVertex 0 0 0\nVertex 1 0 0\nVertex 0 1 0\nEndLoop\n"
        "EndFacet\nEndSolid\n",
        "\xEF\xBB\xBFsolid  \nfacet\nloop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
        "0\nendloop\nendfacet\n"
        "endsolid  \n"})
    expect_read(text, kTriangle, "");
}

TEST(StlAsciiDialect, NotesLinesOfOtherWords) {
  expect_read("solid s\ncolor 1 0 0\n" + kFacet + "endsolid s\n", kTriangle,
              "1 line of no STL keyword passed over, the first 'color' in line 2\n");
  expect_read("solid s\n" + kFacet + "name left\nmaterial 7\nendsolid s\n", kTriangle,
              "2 lines of no STL keyword passed over, the first 'name' in line 9\n");
  expect_read("solid s\nfacet normal 0 0 1\nattribute 3\nouter loop\n" + kCorners +
                  "endloop\nattribute 4\nendfacet\nendsolid s\n",
              kTriangle,
              "2 lines of no STL keyword passed over, the first 'attribute' in line 3\n");
}

// There it may be a vertex.
TEST(StlAsciiDialect, RefusesOtherWordsWithinALoop) {
  for (const std::string word : {"vertx 0 0 0", "color 1 0 0", "0 0 0"}) {
    const std::string shown = word.substr(0, word.find(' '));
    expect_refused("solid s\nfacet normal 0 0 1\nouter loop\n" + word + "\n",
                   "line 4: '" + shown + "' is not expected here");
  }
}

TEST(StlAsciiDialect, NotesTextBehindTheSolid) {
  expect_read("solid s\n" + kFacet + "endsolid s\nwritten by hand\n", kTriangle,
              "1 line behind 'endsolid' passed over, the first 'written' in line 10\n");
  expect_read("solid s\n" + kFacet + "endsolid\n# a\n# b\n", kTriangle,
              "2 lines behind 'endsolid' passed over, the first '#' in line 10\n");
  expect_read("solid s\n" + kFacet + "endsolid\nbetween\nsolid t\nendsolid\n", kTriangle,
              "1 line behind 'endsolid' passed over, the first 'between' in line 10\n");
}

TEST(StlAsciiDialect, NotesAMissingEndsolid) {
  const std::string note =
      "no 'endsolid' behind the last facet; if facets are missing, copy or export the file again\n";
  expect_read("solid s\n" + kFacet, kTriangle, note);
  expect_read("solid s\n" + kFacet + "endsolid\nsolid t\n" + kFacet,
              kTriangle + "1: 0 0 0, 1 0 0, 0 1 0\n", note);
  expect_read("solid s\n" + kFacet + "solid t\nendsolid\n", kTriangle,
              "1 solid begun before 'endsolid', the first 'solid' in line 9\n");
}

TEST(StlAsciiDialect, RefusesAFileThatEndsWithinAFacet) {
  const std::string whole = "solid s\n" + kFacet;
  for (const std::size_t lost : {3U, 9U, 30U})
    expect_refused(whole.substr(0, whole.size() - lost), "it is truncated");
  for (const std::string part : {"f", "endso", "color"})
    expect_refused(whole + part, "line 10: the file ends in front of 'endsolid': it is truncated");
}

}  // namespace
}  // namespace planetree::octree
