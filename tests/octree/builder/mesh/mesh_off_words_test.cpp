// OFF files whose records do not keep to lines.

#include <gtest/gtest.h>

#include <string>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

const std::string kVertices = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
const std::string kFaces = "3 0 1 2\n3 1 3 2\n";
const std::string kLog = "0: 0 0 0, 1 0 0, 0 1 0\n1: 1 0 0, 1 1 0, 0 1 0\n";

std::string on_one_line(std::string text) {
  for (char& c : text) c = c == '\n' ? ' ' : c;
  return text;
}

void expect_read(const std::string& text, const std::string& log = kLog) {
  for (const std::uint64_t memory_bytes : {std::uint64_t{0}, MeshScratch::kMemoryBytes}) {
    const Reading reading = read_bytes(text, ".off", memory_bytes);
    EXPECT_EQ(reading.error, "") << text;
    EXPECT_EQ(reading.log, log) << text;
  }
}

void expect_refused(const std::string& text, const std::string& message) {
  const Reading reading = read_bytes(text, ".off");
  EXPECT_FALSE(reading.summary) << message;
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_NE(reading.error.find(message), std::string::npos) << "said: " << reading.error;
}

TEST(OffWords, ReadsCountsOverLines) {
  expect_read("OFF\n4\n2\n0\n" + kVertices + kFaces);
  expect_read("OFF 4\n\n2 # faces\n# edges\n5\n" + kVertices + kFaces);
  expect_read("4\n2\n0\n" + kVertices + kFaces);
  expect_read("off\n4 2\n" + kVertices + kFaces);
}

TEST(OffWords, ReadsAFileOnOneLine) {
  expect_read("OFF 4 2 0 " + on_one_line(kVertices + kFaces));
  expect_read("OFF\n4 2 0 " + on_one_line(kVertices + kFaces));
  expect_read("4 2 5 " + on_one_line(kVertices) + "\n" + on_one_line(kFaces) + "\n");
  expect_read("OFF\n4 2 0\n" + on_one_line(kVertices + kFaces));
  expect_read("OFF 4 2 0 " + on_one_line(kVertices) + "# vertices\n" + kFaces);
}

TEST(OffWords, ReadsSeveralVerticesOnALine) {
  expect_read("OFF\n4 2 0\n0 0 0  1 0 0\n0 1 0\n1 1 0\n" + kFaces);
  expect_read("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0 1 1 0\n" + kFaces);
  expect_read("OFF\n4 2 0\n0 0 0 1 0 0\n0 1 0 1 1 0\n" + kFaces);
  expect_read("NOFF\n4 2 0\n0 0 0 7 7 7 1 0 0 7 7 7\n0 1 0 7 7 7\n1 1 0 7 7 7\n" + kFaces);
}

TEST(OffWords, ReadsVerticesAndFacesOverLines) {
  expect_read("OFF\n4 2 0\n0 0\n0\n1 0\n0\n0 1\n0\n1 1\n0\n" + kFaces);
  expect_read("OFF\n4 2 0\n" + kVertices + "3\n0 1 2\n3\n1 3 2\n");
  expect_read("OFF\n4 2 0\n" + kVertices + "3 0 1 # two\n2\n3 1 3 2 255 0 0\n");
  expect_read("STOFF\n4 2 0\n0 0 0\n9 9\n1 0 0\n9 9\n0 1 0\n9 9\n1 1 0\n9 9\n" + kFaces);
}

TEST(OffWords, ReadsSeveralFacesOnALine) {
  expect_read("OFF\n4 2 0\n" + kVertices + on_one_line(kFaces));
  expect_read("OFF\n4 3 0\n" + kVertices + on_one_line(kFaces) + "\n3 0 1 2\n",
              kLog + "2: 0 0 0, 1 0 0, 0 1 0\n");
  expect_read("OFF\n4 4 0\n" + kVertices + on_one_line(kFaces) + "3 0 1 2\n3 0 1 2\n",
              kLog + "2: 0 0 0, 1 0 0, 0 1 0\n3: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(OffWords, TakesWordsBehindAFaceForItsColour) {
  for (const std::string colour : {" 255 0 0", " 0.5 0.25 1.0 1.0", " 7", " 3 0 1 2"})
    expect_read("OFF\n4 2 0\n" + kVertices + "3 0 1 2" + colour + "\n3 1 3 2" + colour + "\n");
}

TEST(OffWords, RefusesColoursThatMayBeFaces) {
  expect_refused("OFF\n4 2 0\n0 0 0 1 0 0\n0 1 0\n1 1 0\n3 0 1 2 255 0 0\n3 1 3 2 255 0 0\n",
                 "line 6: '255' follows the last declared value");
  expect_refused("OFF\n4 2 0\n" + kVertices + "3\n0 1 2 255 0 0\n3 1 3 2\n",
                 "line 7: a face that goes over lines, with further words behind it");
  expect_refused("OFF 4 2 0 " + on_one_line(kVertices) + "\n3 0 1 2 7\n3 1 3 2 7\n",
                 "line 2: '7' follows the last declared value");
}

// With three or four numbers, the next vertex is not to be found.
TEST(OffWords, RefusesColouredVerticesThatShareLines) {
  expect_refused(
      "COFF\n4 2 0\n0 0 0 1 1 1 1 1 0 0 1 1 1 1\n0 1 0 1 1 1 1\n1 1 0 1 1 1 1\n" + kFaces,
      "line 4: a vertex of more or fewer numbers than the first");
  expect_refused("CNOFF\n4 2 0\n0 0\n0\n1 0 0\n", "line 3: the line ends in front of 'z'");
  expect_refused("NCOFF\n4 2 0\n0 0 0 0 0 1\n255 0 0\n1 0 0 0 0 1\n255 0 0\n",
                 "line 4: a vertex of more or fewer numbers than the first");
}

TEST(OffWords, RefusesWrongCounts) {
  const std::string body = kVertices + kFaces;
  for (const std::string& text : {" " + on_one_line(body), "\n" + on_one_line(body), "\n" + body}) {
    expect_refused("OFF 4 3 0" + text, "the file ends at record 2 of 3 'face'");
    expect_refused("OFF 4 1 0" + text, "follow");
    expect_refused("OFF 5 2 0" + text, "");
    expect_refused("OFF 3 2 0" + text, "");
  }
  expect_refused("OFF\n4\n2\n" + body,
                 "line 2: '4' is not the numbers of vertices, faces and edges");
}

}  // namespace
}  // namespace planetree::octree
