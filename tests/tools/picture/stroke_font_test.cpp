#include "tools/picture/stroke_font.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace planetree::tools {
namespace {

std::string shape_of(char c) {
  const Stroke stroke = text_stroke({{0, 20}, std::string(1, c)});
  std::string shape;
  for (const auto& path : stroke.paths) {
    for (const Place& place : path)
      shape += std::to_string(place.x) + ',' + std::to_string(place.y) + ' ';
    shape += ';';
  }
  return shape;
}

TEST(StrokeFont, HasADifferentGlyphForEveryCharacter) {
  std::set<std::string> shapes;
  for (char c = '!'; c <= '~'; ++c) {
    shapes.insert(shape_of(c));
    // Every glyph has lines, within the height of letters with tails.
    for (const auto& path : text_stroke({{0, 20}, std::string(1, c)}).paths) {
      EXPECT_GE(path.size(), 2u) << c;
      for (const Place& place : path) {
        EXPECT_GE(place.y, 20 - 0.5 - 10) << c;
        EXPECT_LE(place.y, 20 - 0.5 + 3) << c;
        EXPECT_GE(place.x, 0) << c;
        EXPECT_LE(place.x, text_length(std::string(1, c), 9) + 0.5) << c;
      }
    }
  }
  EXPECT_EQ(shapes.size(), 94u);
  EXPECT_EQ(text_stroke({{0, 20}, " "}).paths.size(), 0u);
}

TEST(StrokeFont, GivesEveryOtherCharacterABox) {
  EXPECT_EQ(text_length("a\xc3\xa4"
                        "b",
                        9),
            text_length("a\x7f"
                        "b",
                        9));
  EXPECT_EQ(text_stroke({{0, 20}, "\xe2\x82\xac"}).paths.size(), 1u);
}

TEST(StrokeFont, PlacesTextAtItsAnchor) {
  const auto left_of = [](Anchor anchor) {
    return text_stroke({{100, 20}, "HH", 9, anchor}).paths.front().front().x;
  };
  EXPECT_EQ(text_length("HH", 9), 15);
  EXPECT_EQ(left_of(Anchor::kStart), 100.5);
  EXPECT_EQ(left_of(Anchor::kMiddle), 93.5);
  EXPECT_EQ(left_of(Anchor::kEnd), 85.5);
}

TEST(StrokeFont, ShortensTextInItsMiddle) {
  EXPECT_EQ(shortened("short", 9, 100), "short");
  const std::string shorter = shortened("a-long-name-of-a-file.ptree", 9, 100);
  EXPECT_LE(text_length(shorter, 9), 100);
  EXPECT_TRUE(shorter.starts_with("a-l") && shorter.ends_with("tree")) << shorter;
  EXPECT_NE(shorter.find("..."), std::string::npos);
}

}  // namespace
}  // namespace planetree::tools
