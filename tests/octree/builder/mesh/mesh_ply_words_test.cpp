// Ascii PLY bodies whose records do not keep to lines.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

/// Two triangles over four vertices.
const std::string kLog = "0: 0 0 0, 1 0 0, 0 1 0\n1: 1 0 0, 1 1 0, 0 1 0\n";
const std::string kVertices = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
const std::string kFaces = "3 0 1 2\n3 1 3 2\n";

std::string header(const std::string& more_of_vertex = "", int vertices = 4, int faces = 2) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\n" + more_of_vertex +
         "element face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

void expect_read(const std::string& text) {
  for (const std::uint64_t memory_bytes : {std::uint64_t{0}, MeshScratch::kMemoryBytes}) {
    const Reading reading = read_bytes(text, ".ply", memory_bytes);
    EXPECT_EQ(reading.error, "") << text;
    EXPECT_EQ(reading.log, kLog) << text;
    EXPECT_EQ(notes_of(reading), "") << text;
  }
}

void expect_refused(const std::string& text, const std::string& message) {
  const Reading reading = read_bytes(text, ".ply");
  EXPECT_FALSE(reading.summary) << message;
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_NE(reading.error.find(message), std::string::npos) << "said: " << reading.error;
}

/// `text` with every `line`th line end in place of a blank.
std::string on_one_line(std::string text) {
  for (char& c : text) c = c == '\n' ? ' ' : c;
  return text;
}

TEST(PlyWords, ReadsRecordsOverLines) {
  expect_read(header() + "0\n0\n0\n1\n0\n0\n0\n1\n0\n1\n1\n0\n3\n0\n1\n2\n3\n1\n3\n2\n");
  expect_read(header("property uchar red\nproperty uchar green\n") +
              "0 0 0\n255 7\n1 0 0\n255 7\n\n0 1 0\n255 7\n1 1 0\n255 7\n" + kFaces);
  expect_read(header() + kVertices + "3 0 1\n2\n3\n1 3 2\n");
  expect_read(header("property list uchar float weights\n") +
              "0 0 0 2\n1 2\n1 0 0 0\n0 1 0\n1 5\n1 1 0 1 7\n" + kFaces);
}

TEST(PlyWords, ReadsSeveralRecordsOnALine) {
  expect_read(header() + "0 0 0 1 0 0\n0 1 0 1 1 0\n3 0 1 2 3 1 3 2\n");
  expect_read(header() + on_one_line(kVertices) + "\n" + on_one_line(kFaces) + "\n");
  expect_read(header() + kVertices + on_one_line(kFaces));
  expect_read(header() + "0 0 0 1 0 0\n0 1 0\n1 1 0\n" + kFaces);
}

TEST(PlyWords, ReadsABodyOnOneLine) {
  expect_read(header() + on_one_line(kVertices + kFaces));
  expect_read(header() + on_one_line(kVertices + kFaces) + "\n\n");
  expect_read(header() + "  " + on_one_line(kVertices) + "\t" + on_one_line(kFaces) + "\r\n");
}

// Lines that end wherever they are full.
TEST(PlyWords, ReadsLinesThatEndWithinRecords) {
  expect_read(header() + "0 0 0 1 0 0 0\n1 0 1 1 0 3 0\n1 2 3 1 3 2\n");
  expect_read(header() + "0 0 0 1 0 0 0 1\n0 1 1 0 3 0 1 2 3\n1 3 2\n");
  expect_read(header() + on_one_line(kVertices) + "3\n0 1 2 3 1 3\n2");
}

// The window of 4 KiB ends in every word sooner or later.
TEST(PlyWords, ReadsALineOfManyWindows) {
  constexpr int kCopies = 3000;
  std::string vertices, faces, log;
  for (int i = 0; i < kCopies; ++i) {
    vertices += on_one_line(kVertices);
    const std::string a = std::to_string(4 * i), b = std::to_string(4 * i + 1),
                      c = std::to_string(4 * i + 2);
    faces += "3 " + a + " " + b + "   " + c + " ";
    log += std::to_string(i) + ": 0 0 0, 1 0 0, 0 1 0\n";
  }
  for (const std::string end : {"", "\n", " \r\n", "comment unit mm"})
    for (const std::uint64_t memory_bytes : {std::uint64_t{0}, MeshScratch::kMemoryBytes}) {
      const Reading reading =
          read_bytes(header("", 4 * kCopies, kCopies) + vertices + faces + end, "", memory_bytes);
      EXPECT_EQ(reading.error, "");
      EXPECT_EQ(reading.log, log);
    }
}

TEST(PlyWords, PassesOverComments) {
  expect_read(header() + kVertices + kFaces + "comment unit mm");
  expect_read(header() + kVertices + on_one_line(kFaces) + "comment unit mm 3 0 1 2\n");
  expect_read(header() + "comment 1 2 3\n" + kVertices + "obj_info 4 of 4\n" + kFaces);
  expect_read(header() +
              "0 0 0\n1 0 0\n  comment\n0 1 0\n1 1 0\n3 0 1\ncomment within\n2\n3 1 3 2\n");
}

TEST(PlyWords, IgnoresTheEndMarksOfOldSystems) {
  for (const std::string& end : {std::string("\x1a"), std::string("\n\x1a"),
                                 std::string("\r\n\x1a\n"), std::string(1, '\0')})
    expect_read(header() + kVertices + kFaces.substr(0, kFaces.size() - 1) + end);
}

TEST(PlyWords, NotesZeroBytesAtTheEnd) {
  for (const std::size_t zeros : {100U, 5000U, 200000U}) {
    const Reading reading = read_bytes(header() + kVertices + kFaces + std::string(zeros, '\0'));
    EXPECT_EQ(reading.log, kLog);
    EXPECT_EQ(notes_of(reading),
              std::to_string(zeros + 1) +
                  " bytes of zero or Ctrl-Z at the end are not read; if the mesh "
                  "is not whole, copy it again\n");
  }
  expect_refused(header() + kVertices + std::string(100, '\0'), "the file ends at record 0 of 2");
}

// A word too few or too many must not move all that follow.
TEST(PlyWords, RefusesARecordThatLeavesItsLine) {
  expect_refused(header() + "0 0 0\n1 0\n0 1 0\n1 1 0\n" + kFaces,
                 "line 11: the line ends in front of 'z'");
  expect_refused(header() + "0 0 0\n1 0 0 0\n0 1 0\n1 1 0\n" + kFaces,
                 "line 11: '0' follows the last declared value");
  expect_refused(header() + "0 0 0\n1 0 0 0 0\n0 1 0\n1 1 0\n" + kFaces,
                 "line 11: '0' follows the last declared value");
  expect_refused(header() + kVertices + "3 0 1\n3 1 3 2\n",
                 "line 14: the line ends in front of 'vertex_indices'");
  expect_refused(header("property uchar red\n") + "0 0 0\n9\n1 0 0\n0 1 0\n9\n1 1 0\n9\n" + kFaces,
                 "line 13: the line ends in front of 'red'");
}

TEST(PlyWords, RefusesVerticesOfMoreNumbersThanDeclared) {
  const std::string row = " 255 255 255\n";
  expect_refused(header() + "0 0 0 1\n1 0 0 1\n0 1 0 1\n1 1 0 1\n" + kFaces,
                 "line 10: '1' follows the last declared value");
  expect_refused(header() + "0 0 0" + row + "1 0 0" + row + "0 1 0" + row + "1 1 0" + row + kFaces,
                 "line 12: '255' follows the last declared value");
  expect_refused(header() + "0 0 0 0.5\n1 0 0 0.5\n0 1 0 0.5\n1 1 0 0.5\n" + kFaces,
                 "line 10: '0.5' follows the last declared value");
}

TEST(PlyWords, RefusesWrongCounts) {
  for (const std::string& body : {kVertices + kFaces, on_one_line(kVertices + kFaces),
                                  on_one_line(kVertices) + "\n" + on_one_line(kFaces)}) {
    expect_refused(header("", 4, 3) + body, "the file ends at record 2 of 3 'face'");
    expect_refused(header("", 4, 1) + body, "follow");
    expect_refused(header("", 5, 2) + body, "");
    expect_refused(header("", 3, 2) + body, "");
  }
  expect_refused(header() + on_one_line(kVertices + kFaces) + "7",
                 "line 10: '7' follows the last declared value");
  expect_refused(header() + on_one_line(kVertices) + "3 0 1 2 3 1",
                 "line 10: the file ends in front of 'vertex_indices'");
}

TEST(PlyWords, RefusesALongListThatIsNotThere) {
  expect_refused(header() + kVertices + "1000000000 0 1 2\n3 1 3 2\n",
                 "line 15: the file ends in front of 'vertex_indices'");
  expect_refused(header("", 4, 1) + kVertices + "9000000000000000000 0\n" +
                     std::string(std::size_t{1} << 24, '\n') + "0 0 " +
                     std::string((std::size_t{1} << 24) + 100, ' ') + "0\n",
                 "line 14: the record is longer than 32 MiB; write such a mesh as a binary PLY");
}

}  // namespace
}  // namespace planetree::octree
