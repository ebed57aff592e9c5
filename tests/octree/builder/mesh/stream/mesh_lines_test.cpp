#include "octree/builder/mesh/stream/mesh_lines.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

// Windows end in every line sooner or later, and within "\r\n".
TEST(MeshLines, MatchTheLinesOfTheText) {
  std::mt19937 random(2);
  for (const std::string ends : {"n", "r", "rn", "nrb"}) {
    std::string text;
    for (int i = 0; i < 20000; ++i) {
      text += std::string(random() % 100 == 0 ? 6000 : random() % 9, "x .#"[random() % 4]);
      const char end = ends[random() % ends.size()];
      text += end == 'b' ? "\r\n" : end == 'n' ? "\n" : "\r";
    }
    // Lines that fill a window but for its last character.
    for (int i = 0; i < 5; ++i) text += std::string(MeshWindow::kRecordBytes - 1, 'y') + "\r\n";
    text += "end";
    const TemporaryFile path(text, ".txt");
    const auto file = MeshFile::open(path.path());
    ASSERT_TRUE(file);
    for (const LineComment comment : {LineComment::kNone, LineComment::kHash}) {
      MeshLines lines(*file, {5, 9}, comment, 1000);
      LineScanner expected(text, {5, 9}, LineEnd::kAny, comment);
      while (expected.next()) {
        ASSERT_TRUE(lines.next());
        ASSERT_EQ(lines.line(), expected.line());
        ASSERT_EQ(lines.position().offset, expected.position().offset);
        ASSERT_EQ(lines.position().line, expected.position().line);
        ASSERT_EQ(lines.after().offset, expected.after().offset);
      }
      EXPECT_FALSE(lines.next());
      EXPECT_FALSE(lines.failure());
      EXPECT_EQ(lines.after().offset, text.size());
    }
  }
}

TEST(MeshLines, MayBeThirtyTwoMebibytesLong) {
  const std::string text = "ab\n" + std::string(MeshLines::kMaxLineBytes - 1, 'c') + "\n";
  for (const bool longer : {false, true}) {
    const TemporaryFile path(longer ? text.substr(0, text.size() - 1) + "cc\n" : text, ".txt");
    const auto file = MeshFile::open(path.path());
    ASSERT_TRUE(file);
    MeshLines lines(*file, {});
    ASSERT_TRUE(lines.next());
    EXPECT_EQ(lines.next(), !longer);
    EXPECT_EQ(lines.failure().has_value(), longer);
    if (!longer) continue;
    EXPECT_EQ(lines.failure()->code, ErrorCode::kBadInput);
    EXPECT_EQ(lines.failure()->offset, 3u);
    EXPECT_STREQ(lines.failure()->text,
                 "line 2: is longer than 32 MiB; write such a mesh as a binary PLY");
  }
}

}  // namespace
}  // namespace planetree::octree
