#include "tools/picture/legend.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "tools/picture/band_scale.h"
#include "tools/picture/picture_axes.h"
#include "tools/picture/raster_painter.h"
#include "tools/picture/stroke_font.h"

namespace planetree::tools {
namespace {

std::multiset<std::string> texts_of(const Drawing& drawing) {
  std::multiset<std::string> texts;
  for (const DrawnShape& shape : drawing.shapes)
    if (const auto* line = std::get_if<TextLine>(&shape)) texts.insert(line->text);
  return texts;
}

TEST(BandScale, RoundsToOneTwoAndFive) {
  EXPECT_EQ(round_length(1), 1);
  EXPECT_EQ(round_length(1.99), 1);
  EXPECT_EQ(round_length(4.9), 2);
  EXPECT_EQ(round_length(730), 500);
  EXPECT_DOUBLE_EQ(round_length(0.03), 0.02);
}

// As many bands as a slice can have differ from each other, on every ramp and between ramps.
TEST(BandScale, GivesEveryBandAColourOfItsOwn) {
  std::set<std::tuple<int, int, int>> colours;
  for (const ColourRamp* ramp : {&kBlues, &kOranges, &kGreys, &kGreens})
    for (const ColourBand& band : BandScale(*ramp, 1, 18).bands(18))
      colours.insert({band.colour.red, band.colour.green, band.colour.blue});
  EXPECT_EQ(colours.size(), 4u * 18u);
}

TEST(BandScale, PutsValuesIntoTheirBands) {
  const BandScale scale(kBlues, 0.5, 4);
  EXPECT_EQ(scale.band_of(0), 0u);
  EXPECT_EQ(scale.band_of(0.49), 0u);
  EXPECT_EQ(scale.band_of(0.5), 1u);
  EXPECT_EQ(scale.band_of(1e300), 3u);
  EXPECT_EQ(scale.bands(2)[1].lower, 0.5);
  EXPECT_EQ(scale.colour(0), kBlues.front());
  EXPECT_EQ(scale.colour(3), kBlues.back());
  EXPECT_EQ(BandScale(kBlues, 1, 1).colour(0), kBlues.front());
}

Legend sample_legend() {
  Legend legend;
  ColourBar bar{"quantity", "heading", "above", "below", {}};
  for (int i = -2; i < 3; ++i)
    bar.bands.push_back({i * 10.0, i * 10.0 + 10, {static_cast<std::uint8_t>(100 + i), 0, 0}});
  legend.bars.push_back(bar);
  legend.groups.push_back({"group", {{{1, 2, 3}, false, "entry"}}});
  legend.place(20, 10, 200);
  return legend;
}

TEST(Legend, DrawsBarsWhereItSays) {
  const Legend legend = sample_legend();
  Drawing drawing;
  drawing.width = 20 + Legend::kWidth;
  drawing.height = legend.bottom();
  legend.draw(drawing);
  const PngImage image = paint(drawing);
  const ColourBar& bar = legend.bars[0];
  for (std::uint32_t i = 0; i < bar.height; ++i)
    EXPECT_EQ(image.at(bar.left + 3, bar.top + i).red, 102 - i / 40) << i;
  EXPECT_NE(image.at(bar.left + 3, bar.top - 1).red, 102);
  EXPECT_EQ(texts_of(drawing),
            (std::multiset<std::string>{"-10", "-20", "0", "10", "20", "30", "above", "below",
                                        "entry", "group", "heading"}));
}

// Labels of many bands would touch each other.
TEST(Legend, LeavesOutTicksThatAreTooClose) {
  Legend legend;
  ColourBar bar{"quantity", "heading", "", "", {}};
  for (int i = 0; i < 36; ++i) bar.bands.push_back({i * 0.1, i * 0.1 + 0.1, {}});
  legend.bars.push_back(bar);
  legend.place(0, 0, 260);
  Drawing drawing;
  legend.draw(drawing);
  EXPECT_EQ(texts_of(drawing), (std::multiset<std::string>{"0", "0.5", "1", "1.5", "2", "2.5", "3",
                                                           "3.5", "heading"}));
}

TEST(PictureAxes, LabelTicksWithCoordinates) {
  Drawing drawing;
  draw_axes({90, 50, 400, 200, 'x', 'z', -1000, 20, 5}, drawing);
  const auto texts = texts_of(drawing);
  for (const char* text :
       {"-1000", "-500", "0", "500", "1000", "x", "z", "-200", "-800", "500 model units"})
    EXPECT_GE(texts.count(text), 1u) << text;
}

// Six digits would make all labels equal.
TEST(PictureAxes, LabelTicksWithAllDigitsThatDiffer) {
  Drawing drawing;
  draw_axes({90, 50, 400, 200, 'x', 'z', 1e6, 0, 0.001}, drawing);
  const auto texts = texts_of(drawing);
  EXPECT_EQ(texts.count("1000000.1") + texts.count("1000000.2"), 2u);
  for (const std::string& text : texts) EXPECT_EQ(texts.count(text), 1u) << text;
}

TEST(PictureAxes, TakeRoomForTheLongestLabel) {
  EXPECT_EQ(left_room({0, 50, 400, 200, 'x', 'z', 0, 20, 5}), 86u);
  const double longest = text_length("1000000000.12", 9);
  EXPECT_GE(left_room({0, 50, 400, 200, 'x', 'z', 0, 1e9 + 0.2, 0.001}), longest + 40);
}

// Far from the origin, coordinates of ticks would be equal.
TEST(PictureAxes, HaveNoTicksThatCannotBeToldApart) {
  Drawing drawing;
  draw_axes({90, 50, 400, 200, 'x', 'z', 1e300, 1e300, 1}, drawing);
  EXPECT_EQ(texts_of(drawing), (std::multiset<std::string>{"100 model units", "x", "z"}));
}

}  // namespace
}  // namespace planetree::tools
