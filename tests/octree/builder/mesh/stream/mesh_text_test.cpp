#include "octree/builder/mesh/stream/mesh_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace planetree::octree {
namespace {

double real(std::string_view word) {
  double value = -77;
  EXPECT_TRUE(parse_real(word, value)) << word;
  return value;
}

float narrow(std::string_view word) {
  float value = -77;
  EXPECT_TRUE(parse_real(word, value)) << word;
  return value;
}

bool is_number(std::string_view word) {
  double value = 0;
  return parse_real(word, value);
}

TEST(MeshText, ReadsNumbersCorrectlyRounded) {
  EXPECT_EQ(real("0.1"), 0.1);
  EXPECT_EQ(real("+1.5"), 1.5);
  EXPECT_EQ(real("-2."), -2.0);
  EXPECT_EQ(real(".5"), 0.5);
  EXPECT_EQ(real("1E3"), 1000.0);
  EXPECT_EQ(real("9007199254740993"), 9007199254740992.0);
  EXPECT_EQ(real("5e-324"), std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(real("1.7976931348623157e308"), std::numeric_limits<double>::max());
}

TEST(MeshText, RoundsFloatsOnceAndNotThroughDouble) {
  EXPECT_EQ(narrow("0.1"), 0.1F);
  EXPECT_EQ(narrow("1e-45"), std::numeric_limits<float>::denorm_min());
  // Just above the midpoint of 1 and the next float; rounded to double it is the midpoint.
  EXPECT_EQ(narrow("1.00000005960464477539062500001"), std::nextafter(1.0F, 2.0F));
}

// Reading both at once gives the same as reading each.
TEST(MeshText, ReadsFloatAndDoubleTogether) {
  std::mt19937_64 random(5);
  std::vector<std::string> words = {"0.1",
                                    "-0",
                                    "1e-45",
                                    "1e39",
                                    "-1e-60",
                                    "1.17549435e-38",
                                    "nan",
                                    "inf",
                                    "1.00000005960464477539062500001",
                                    "1.000000059604644775390625",
                                    "3.4028235677973366e38",
                                    "16777217"};
  for (int i = 0; i < 20000; ++i) {
    const auto bits = static_cast<std::uint32_t>(random());
    const auto value = std::bit_cast<float>(bits);
    // At, and about, the middle between two floats.
    const double middle =
        0.5 * static_cast<double>(value) + 0.5 * static_cast<double>(std::nextafter(value, 2e38F));
    char word[400];
    std::snprintf(word, sizeof word, "%.*g", static_cast<int>(1 + random() % 40), middle);
    words.push_back(word);
  }
  for (const std::string& word : words) {
    float together = 0, alone = 0;
    double nearest = 0, wide = 0;
    ASSERT_TRUE(parse_real(word, together, nearest) && parse_real(word, alone) &&
                parse_real(word, wide));
    EXPECT_EQ(std::bit_cast<std::uint32_t>(together), std::bit_cast<std::uint32_t>(alone)) << word;
    EXPECT_EQ(std::bit_cast<std::uint64_t>(nearest), std::bit_cast<std::uint64_t>(wide)) << word;
  }
}

TEST(MeshText, OverflowsAndUnderflowsCorrectly) {
  EXPECT_EQ(real("1e400"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(real("1e99999999999999999999"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(real("0.0001e400"), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isinf(real("-1e400")));
  EXPECT_EQ(real("1e-400"), 0.0);
  EXPECT_EQ(real("12345e-400"), 0.0);
  EXPECT_EQ(real("1e-99999999999999999999"), 0.0);
  EXPECT_EQ(real("0e400"), 0.0);
  EXPECT_EQ(narrow("1e39"), std::numeric_limits<float>::infinity());
  EXPECT_EQ(narrow("1e-60"), 0.0F);
  EXPECT_EQ(real("1" + std::string(400, '0')), std::numeric_limits<double>::infinity());
  EXPECT_EQ(real("0." + std::string(400, '0') + "1"), 0.0);
}

TEST(MeshText, ReadsEverySpellingOfNan) {
  EXPECT_TRUE(std::isnan(real("nan")));
  EXPECT_TRUE(std::isnan(real("-NaN")));
  EXPECT_TRUE(std::isnan(real("-1.#IND")));
  EXPECT_TRUE(std::isnan(real("1.#INF00")));
  EXPECT_EQ(real("inf"), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isinf(real("-Infinity")));
}

TEST(MeshText, RefusesWhatIsNoNumber) {
  for (const char* word : {"", "+", "-", "+-1", "abc", "1.5x", "1,5", "--1", "0x10", "."}) {
    EXPECT_FALSE(is_number(word)) << word;
  }
}

TEST(MeshText, ReadsIntegersAndKeepsTheRest) {
  std::string_view word = "-12/7";
  std::int64_t value = 0;
  EXPECT_TRUE(take_integer(word, value));
  EXPECT_EQ(value, -12);
  EXPECT_EQ(word, "/7");
  word = "+3";
  EXPECT_TRUE(take_integer(word, value));
  EXPECT_EQ(value, 3);
  EXPECT_EQ(word, "");
  word = "99999999999999999999";
  EXPECT_TRUE(take_integer(word, value));
  EXPECT_EQ(value, std::numeric_limits<std::int64_t>::max());
  word = "-99999999999999999999";
  EXPECT_TRUE(take_integer(word, value));
  EXPECT_EQ(value, std::numeric_limits<std::int64_t>::min());
  for (const char* none : {"", "x", "+", "-", "/1"}) {
    word = none;
    EXPECT_FALSE(take_integer(word, value)) << none;
    EXPECT_EQ(word, none);
  }
}

TEST(MeshText, CountsLinesAndBytes) {
  LineScanner lines("a\r\n\n \t\nb c\rd");
  ASSERT_TRUE(lines.next_filled());
  EXPECT_EQ(lines.line(), "a");
  EXPECT_EQ(lines.position().line, 1U);
  ASSERT_TRUE(lines.next_filled());
  EXPECT_EQ(lines.line(), "b c");
  EXPECT_EQ(lines.position().line, 4U);
  EXPECT_EQ(lines.position().offset, 7U);
  EXPECT_EQ(lines.after().offset, 11U);
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.line(), "d");
  EXPECT_EQ(lines.position().line, 5U);
  EXPECT_EQ(lines.after().offset, 12U);
  EXPECT_FALSE(lines.next());
}

TEST(MeshText, RemovesCommentsOnlyWhereRequested) {
  const std::string_view text = " # a\nb # c\nd#e\n1.#IND -1.#INF#f\n";
  LineScanner lines(text, {}, LineEnd::kAny, LineComment::kHash);
  for (const char* line : {"b ", "d", "1.#IND -1.#INF"}) {
    ASSERT_TRUE(lines.next_filled());
    EXPECT_EQ(lines.line(), line);
  }
  EXPECT_EQ(lines.after().offset, text.size());
  EXPECT_FALSE(lines.next_filled());
  LineScanner kept(text);
  ASSERT_TRUE(kept.next());
  EXPECT_EQ(kept.line(), " # a");
}

TEST(MeshText, EndsLinesByTheRequestedLineEnd) {
  LineScanner newline("a\rb\n\n", {}, LineEnd::kNewline);
  ASSERT_TRUE(newline.next());
  EXPECT_EQ(newline.line(), "a\rb");
  EXPECT_EQ(newline.after().offset, 4U);
  LineScanner carriage_return("a\nb\r\n", {}, LineEnd::kCarriageReturn);
  ASSERT_TRUE(carriage_return.next());
  EXPECT_EQ(carriage_return.line(), "a\nb");
  EXPECT_EQ(carriage_return.after().offset, 4U);
}

TEST(MeshText, QuotesOnlyShortPrintableText) {
  EXPECT_EQ(printable("ab\x01\n\xff"), "ab???");
  EXPECT_EQ(printable(std::string(100, 'x')), std::string(24, 'x') + "...");
}

}  // namespace
}  // namespace planetree::octree
