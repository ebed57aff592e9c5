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

/// The words of a text, each with its line.
template <class Lines>
std::string words_of(Lines& lines) {
  std::string words;
  while (lines.next()) {
    std::string_view rest = lines.line();
    for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest))
      words += std::to_string(lines.position().line) + ' ' + std::string(word) + '\n';
  }
  return words;
}

// Windows of 4 KiB end in words, in comments and within "\r\n".
TEST(MeshLines, DividedHaveTheWordsOfTheText) {
  std::mt19937 random(4);
  for (const int words_a_line : {3, 400, 3000, 100000}) {
    std::string text;
    for (int i = 0; i < 30000; ++i) {
      text += std::string(1 + random() % 9, "abc."[random() % 4]);
      if (random() % 1000 == 0) text += '#';
      if (random() % static_cast<unsigned>(words_a_line) == 0)
        text += std::string_view("\r\n\n\r").substr(random() % 3, 1 + random() % 2);
      text += " \t"[random() % 2];
    }
    const TemporaryFile path(text, ".txt");
    const auto file = MeshFile::open(path.path());
    ASSERT_TRUE(file);
    for (const LineComment comment : {LineComment::kNone, LineComment::kHash}) {
      LineScanner whole(text, {}, LineEnd::kAny, comment);
      const std::string expected = words_of(whole);
      for (const std::size_t window_bytes : {std::size_t{1000}, MeshWindow::kWindowBytes}) {
        MeshLines lines(*file, {}, comment, window_bytes, LongLines::kDivided);
        EXPECT_TRUE(words_of(lines) == expected) << words_a_line;
        EXPECT_FALSE(lines.failure());
        EXPECT_EQ(lines.after().offset, text.size());
      }
    }
  }
}

TEST(MeshLines, EndInFrontOfZeroBytes) {
  for (const std::string& end :
       {std::string("\n"), std::string(10, '\0'), std::string("\n\x1a\r\n"),
        std::string(100000, '\0'), std::string(70, ' ') + '\0' + '\n'}) {
    const TemporaryFile path("one\ntwo" + end, ".txt");
    const auto file = MeshFile::open(path.path());
    ASSERT_TRUE(file);
    MeshLines lines(*file, {});
    EXPECT_EQ(words_of(lines), "1 one\n2 two\n");
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
