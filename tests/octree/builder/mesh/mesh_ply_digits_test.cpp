// Coordinates of an ascii PLY that have more digits than the declared float holds.

#include <gtest/gtest.h>

#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "octree/builder/mesh/mesh_size.h"
#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

std::string ply(const std::string& rows, const std::string& type = "float") {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n";
  for (const char* axis : {"x", "y", "z"}) text += "property " + type + " " + axis + "\n";
  return text + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" + rows +
         "3 0 1 2\n";
}

std::string corner(const std::string& x) { return x + " 0 0\n1 0 0\n0 1 0\n"; }

Reading read_wide(const std::string& text) {
  const TemporaryFile file(text, ".ply");
  RecordingSink sink;
  MeshScratch scratch;
  const auto summary = read_mesh(file.path(), sink, scratch, {.float64 = true});
  Reading reading;
  reading.log = sink.log;
  if (summary) reading.summary = *summary;
  return reading;
}

TEST(PlyDigits, NotesDigitsThatAreLost) {
  EXPECT_EQ(notes_of(read_bytes(ply(corner("5155487.512")))),
            "1 coordinate of more digits than the declared float holds, the first '5155487.512' in "
            "line 10, rounded; --float64 reads them as doubles\n");
  EXPECT_EQ(
      notes_of(read_bytes(ply("0 0 0\n694386.2125 -5155487.512 1\n0 1234567891 0\n"))),
      "3 coordinates of more digits than the declared float holds, the first '694386.2125' in "
      "line 11, rounded; --float64 reads them as doubles\n");
  for (const char* word : {"0.12345678901234", "-1.0000000001", "1.2345678912e-3", "16777217.25",
                           "0.00012345678912", "1234567891"})
    EXPECT_NE(notes_of(read_bytes(ply(corner(word)))), "") << word;
}

TEST(PlyDigits, NotesNoDigitsThatAFloatHolds) {
  for (const char* word :
       {"0.1", "0.100000001", "0.10000000149011612", "0.1000000000000", "123456789",
        "1.5000000000000", "-0.00012345", "1e39", "-1e-60", "nan", "16777216.000", "0.10000000149",
        "12345678848", "3.4028234663852886e+38"})
    EXPECT_EQ(notes_of(read_bytes(ply(corner(word)))), "") << word;
}

// However many digits a program prints a float with.
TEST(PlyDigits, NotesNoFloatThatWasPrintedAsADouble) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> mantissa(-1, 1), exponent(-30, 30);
  for (int digits = 6; digits <= 20; ++digits) {
    std::string rows;
    for (int i = 0; i < 3; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const auto value = static_cast<float>(mantissa(random) * std::exp2(exponent(random)));
        char word[64];
        std::snprintf(word, sizeof word, "%.*g%c", digits, static_cast<double>(value),
                      axis == 2 ? '\n' : ' ');
        rows += word;
      }
    EXPECT_EQ(notes_of(read_bytes(ply(rows))), "") << rows;
  }
}

TEST(PlyDigits, NotesNoneWhereDoublesAreDeclared) {
  for (const char* type : {"double", "float64", "int"})
    EXPECT_EQ(notes_of(read_bytes(ply(corner("1234567891"), type))), "") << type;
}

TEST(PlyDigits, AreReadAsDoublesOnDemand) {
  for (const char* word : {"5155487.5120000001", "0.10000000000000001", "-16777217.25"}) {
    const Reading reading = read_wide(ply(corner(word)));
    EXPECT_EQ(reading.log, "0: " + std::string(word) + " 0 0, 1 0 0, 0 1 0\n");
    EXPECT_EQ(notes_of(reading), "");
    EXPECT_FALSE(reading.summary->float32);
  }
}

TEST(PlyDigits, AreCountedInTheSizeOfTheMesh) {
  const TemporaryFile file(ply(corner("1")), ".ply");
  for (const bool float64 : {false, true}) {
    const auto size = MeshSize::estimate(file.path(), storage::FileCalls::real(), {float64});
    ASSERT_TRUE(size);
    EXPECT_EQ(size->float64, float64);
  }
}

}  // namespace
}  // namespace planetree::octree
