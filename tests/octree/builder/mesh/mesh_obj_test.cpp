#include <gtest/gtest.h>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Reading read_obj_text(const std::string& text) { return read_bytes(text, ".obj"); }

void expect_refused(const std::string& text, const std::string& message) {
  const Reading reading = read_obj_text(text);
  EXPECT_FALSE(reading.summary) << message;
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_NE(reading.error.find(message), std::string::npos) << "said: " << reading.error;
}

TEST(Obj, ReadsVerticesAndFacesAmongOtherStatements) {
  const Reading reading = read_obj_text(
      "# a comment\nmtllib some file.mtl\no thing\nv 0.1 0 -0\nvn 0 0 1\nv 1 0 0 1.0\n"
      "vt 0.5 0.5\nv 0 1 0 0.5 0.5 0.5\ng left\nusemtl red\ns off\nf 1 2 3\nl 1 2\np 1\nfoo f 1\n");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log, "0: 0.10000000000000001 0 0, 1 0 0, 0 1 0\n");
  EXPECT_EQ(reading.summary->vertex_records, 3U);
  EXPECT_EQ(reading.summary->face_records, 1U);
  EXPECT_EQ(reading.summary->triangle_indices, 1U);
  EXPECT_FALSE(reading.summary->float32);
}

TEST(Obj, ReadsEveryFormOfACorner) {
  EXPECT_EQ(
      read_obj_text(kVertices + "f 1 2 3\nf 1/7 2/8 3/9\nf 1//7 2//8 3//9\nf 1/7/4 2/8/5 3/9/6\n"
                                "f -3 -2 -1\nf -3//-1 2/1 -1/1/1\n")
          .log,
      "0: 0 0 0, 1 0 0, 0 1 0\n1: 0 0 0, 1 0 0, 0 1 0\n2: 0 0 0, 1 0 0, 0 1 0\n"
      "3: 0 0 0, 1 0 0, 0 1 0\n4: 0 0 0, 1 0 0, 0 1 0\n5: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(Obj, CountsNegativeNumbersFromTheFace) {
  EXPECT_EQ(read_obj_text(kVertices + "f -1 -2 -3\nv 5 5 5\nf -1 -2 -3\nf -4 -3 -2\n").log,
            "0: 0 1 0, 1 0 0, 0 0 0\n1: 5 5 5, 0 1 0, 1 0 0\n2: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(Obj, FindsVerticesThatFollowTheFace) {
  EXPECT_EQ(read_obj_text("f 1 2 3\n" + kVertices).log, "0: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(Obj, SplitsPolygonsIntoFans) {
  EXPECT_EQ(read_obj_text(kVertices + "v 2 2 0\nv 3 3 0\nf 1 2 3 4 5\nf 3 2 1\n").log,
            "0: 0 0 0, 1 0 0, 0 1 0\n1: 0 0 0, 0 1 0, 2 2 0\n2: 0 0 0, 2 2 0, 3 3 0\n"
            "3: 0 1 0, 1 0 0, 0 0 0\n");
}

TEST(Obj, JoinsContinuedLines) {
  const Reading reading = read_obj_text(
      "v 0 \\\n0 0\nv 1 0 0\r\nv 0\\\r\n1 \\ \r\n  0\nf 1 \\\n2 \\\n3\ng a \\\nf 1 2 3\n"
      "# C:\\models\\\nf 3 2 1\nf 1 2\\\n");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log,
            "0: 0 0 0, 1 0 0, 0 1 0\n1: 0 1 0, 1 0 0, 0 0 0\n"
            "2+1 aside: line 14: has 2 corners, fewer than 3\n");
}

TEST(Obj, SkipsAByteOrderMark) {
  EXPECT_EQ(read_obj_text("\xEF\xBB\xBF" + kVertices + "f 1 2 3 # a comment").log,
            "0: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(Obj, ReadsEveryKindOfLineEndInOneFile) {
  EXPECT_EQ(read_obj_text("v 0 0 0\rv 1 0 0\r\nv 0 1 0\nf 1 2 3\rf 1 \\\r2 3\r").log,
            "0: 0 0 0, 1 0 0, 0 1 0\n1: 0 0 0, 1 0 0, 0 1 0\n");
}

TEST(Obj, SkipsBadRecordsAsAWhole) {
  const Reading reading = read_obj_text(
      kVertices + "v nan 0 0\nf 1 2 3\nf 1 2 3 4\nf 1 2 5\nf 0 1 2\nf -5 1 2\n" +
      "f 1 2\nf\nf 1 2 99999999999999999999 3 1\nf -9223372036854775808 1 2\n" + "f 3 2 1\n");
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(
      reading.log,
      "0: 0 0 0, 1 0 0, 0 1 0\n"
      "1+2 aside: line 6: vertex 4 is not finite\n"
      "3+1 aside: line 7: vertex index 5 is out of range, the mesh has 4 vertices\n"
      "4+1 aside: line 8: vertex index 0 is out of range, the mesh has 4 vertices\n"
      "5+1 aside: line 9: vertex index -5 is out of range, the mesh has 4 vertices\n"
      "6+1 aside: line 10: has 2 corners, fewer than 3\n"
      "7+1 aside: line 11: has 0 corners, fewer than 3\n"
      "8+3 aside: line 12: vertex index 9223372036854775807 is out of range, the mesh has 4 "
      "vertices\n"
      "11+1 aside: line 13: vertex index -9223372036854775808 is out of range, the mesh has 4 "
      "vertices\n"
      "12: 0 1 0, 1 0 0, 0 0 0\n");
}

TEST(Obj, NotesStatementsThatAreNotRead) {
  const std::string mesh = kVertices + "f 1 2 3\n";
  EXPECT_EQ(notes_of(read_obj_text(mesh + "l 1 2\nl 2 3\np 1\n")),
            "3 point or line statements not read, the first 'l' in line 5\n");
  EXPECT_EQ(
      notes_of(read_obj_text("cstype bezier\ndeg 3\nsurf 0 1 0 1 1 2 3 4\nend\n" + mesh)),
      "1 statement of curves, patches or other files not read, the first 'surf' in line 3; export "
      "them as faces\n");
  EXPECT_EQ(
      notes_of(read_obj_text(mesh + "bzp 1 2 3\ncurv 0 1 1 2\nfoo\nF 1 2 3\nl 1 2\n")),
      "2 statements of curves, patches or other files not read, the first 'bzp' in line 5; export "
      "them as faces\n"
      "1 point or line statement not read, the first 'l' in line 9\n"
      "2 unknown statements not read, the first 'foo' in line 7\n");
  EXPECT_EQ(notes_of(read_obj_text("# v\nmtllib a\ng b\no c\ns off\nvn 0 0 1\nvt 0 0\nbevel on\n" +
                                   mesh + "\n")),
            "");
}

TEST(Obj, ReadsFacesUnderTheirOldName) {
  const std::string triangle = "0: 0 0 0, 1 0 0, 0 1 0\n";
  for (const std::string face : {"fo 1 2 3\n", "bevel on\nfo 1/1 2/2 3/3\n", "fo -3 -2 \\\n-1\n"}) {
    const Reading reading = read_obj_text(kVertices + face);
    EXPECT_EQ(reading.log, triangle) << face;
    EXPECT_EQ(notes_of(reading), "");
  }
}

TEST(Obj, RefusesUnreadableStatements) {
  expect_refused("v 0 0\n", "line 1: a vertex of fewer than three numbers; copy or export");
  expect_refused("v 0 0 zero\n", "line 1: 'zero' is not a number");
  expect_refused(kVertices + "f 1 2 x\n", "line 4: 'x' is not a corner of a face");
  expect_refused(kVertices + "f 1 2 3x\n", "line 4: '3x' is not a corner of a face");
  expect_refused(kVertices + "f 1 2 /3\n", "line 4: '/3' is not a corner of a face");
  expect_refused(kVertices + "f 1.5 2 3\n", "line 4: '1.5' is not a corner of a face");
}

TEST(Obj, RefusesAModelWithoutATriangle) {
  expect_refused(kVertices, "no triangle: the mesh has no faces");
  expect_refused("\n", "no triangle: the mesh has no faces");
  expect_refused(
      kVertices + "surf 0 1 0 1 1 2 3\n",
      "no triangle: the mesh has no faces, but 1 statement of curves, patches or other files "
      "not read, the first 'surf' in line 4; export them as faces");
  expect_refused("f 1 2 3\n",
                 "no triangle: all 1 face records are bad, first line 1: vertex index "
                 "1 is out of range, the mesh has 0 vertices");
}

}  // namespace
}  // namespace planetree::octree
