#include "tools/html/plot_axis.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tools/html/html_text.h"
#include "tools/html/plot_figure.h"

namespace planetree::tools {
namespace {

std::vector<std::string> texts_of(const PlotAxis& axis) {
  std::vector<std::string> texts;
  for (const PlotTick& tick : axis.ticks()) texts.push_back(tick.text);
  return texts;
}

PlotAxis axis_of(const std::vector<double>& values, double least = 1e-9) {
  return PlotAxis::logarithmic("title", values, least, short_text);
}

TEST(PlotAxis, BeginsAndEndsAtTicksAroundTheValues) {
  const PlotAxis axis = axis_of({2e-6, 0.3});
  EXPECT_EQ(texts_of(axis),
            (std::vector<std::string>{"1e-6", "1e-5", "1e-4", "1e-3", "0.01", "0.1", "1"}));
  EXPECT_DOUBLE_EQ(axis.place(1e-6), 0);
  EXPECT_DOUBLE_EQ(axis.place(1), 1);
  EXPECT_DOUBLE_EQ(axis.place(1e-3), 0.5);
}

TEST(PlotAxis, HasAFewTicksForAnySpan) {
  for (const double span : {1.0, 1.0001, 1.5, 2.0, 5.0, 20.0, 1e3, 1e6, 1e8}) {
    const PlotAxis axis = axis_of({0.7, 0.7 * span});
    EXPECT_GE(axis.ticks().size(), 3u) << span;
    EXPECT_LE(axis.ticks().size(), 10u) << span;
    EXPECT_GT(axis.place(0.7), 0) << span;
    EXPECT_LT(axis.place(0.7 * span), 1) << span;
    for (std::size_t i = 1; i < axis.ticks().size(); ++i) {
      EXPECT_GT(axis.ticks()[i].place, axis.ticks()[i - 1].place) << span;
      EXPECT_NE(axis.ticks()[i].text, axis.ticks()[i - 1].text) << span;
    }
  }
}

TEST(PlotAxis, PutsValuesWithoutAPlaceInALane) {
  const PlotAxis axis = axis_of({0, 1e-16, 1e-3, 1e-1});
  EXPECT_GT(axis.lane_end(), 0);
  EXPECT_TRUE(axis.is_in_lane(0) && axis.is_in_lane(1e-16) && !axis.is_in_lane(1e-3));
  EXPECT_EQ(axis.place(0), axis.place(1e-16));
  EXPECT_LT(axis.place(0), axis.lane_end());
  EXPECT_GE(axis.place(1e-3), axis.lane_end());
  EXPECT_EQ(axis.ticks().front().text, "< 1e-9");
  EXPECT_EQ(axis_of({1e-3, 1e-1}).lane_end(), 0) << "none where it is not needed";
}

TEST(PlotAxis, NeedsNoValueOutsideTheLane) {
  const PlotAxis axis = axis_of({0, 0});
  EXPECT_GE(axis.ticks().size(), 3u);
  EXPECT_LT(axis.place(0), axis.lane_end());
  EXPECT_GE(axis_of({}).ticks().size(), 3u);
}

TEST(PlotAxis, ShowsAnotherUnitAtTheSamePlaces) {
  const PlotAxis axis = axis_of({0, 2e-6, 0.3});
  const PlotAxis edges = axis.in_units_of(0.003, "edges", short_text);
  EXPECT_EQ(texts_of(edges), (std::vector<std::string>{"1e-3", "0.01", "0.1", "1", "10", "100"}));
  for (const PlotTick& tick : edges.ticks())
    if (tick.text == "1") {
      EXPECT_NEAR(tick.place, axis.place(0.003), 1e-12);
    }
  EXPECT_NEAR(edges.place(0.3 / 0.003), axis.place(0.3), 1e-12);
  EXPECT_EQ(edges.place(0), axis.place(0));
  for (const double span : {1.0, 3.0, 30.0, 1e7})
    for (const double unit : {1.0, 0.7, 1e-3}) {
      const PlotAxis other = axis_of({2e-6, 2e-6 * span}).in_units_of(unit, "edges", short_text);
      EXPECT_GE(other.ticks().size(), 2u) << span << ' ' << unit;
      EXPECT_LE(other.ticks().size(), 10u) << span << ' ' << unit;
      for (const PlotTick& tick : other.ticks()) {
        EXPECT_GE(tick.place, 0);
        EXPECT_LE(tick.place, 1);
      }
    }
}

TEST(PlotAxis, CanBeLinearFromZero) {
  EXPECT_EQ(texts_of(PlotAxis::linear("seconds", 3.2, short_text)),
            (std::vector<std::string>{"0", "1", "2", "3", "4"}));
  for (const double most : {0.0, 1e-6, 0.99, 1.0, 1.01, 4.9, 5.1, 9.99, 60.0, 12345.0}) {
    const PlotAxis axis = PlotAxis::linear("value", most, short_text);
    EXPECT_EQ(axis.place(0), 0);
    EXPECT_LE(axis.place(most), 1 + 1e-9) << most;
    EXPECT_GE(axis.ticks().size(), 3u) << most;
    EXPECT_LE(axis.ticks().size(), 11u) << most;
    EXPECT_NEAR(axis.ticks().back().place, 1, 1e-9);
  }
}

TEST(PlotAxis, CanBeSharesOrNames) {
  const PlotAxis percent = PlotAxis::percent("share");
  EXPECT_EQ(percent.ticks().back().text, "100 %");
  EXPECT_EQ(percent.place(0.25), 0.25);
  const PlotAxis named = PlotAxis::named("memory", {"a", "b"});
  EXPECT_EQ(named.place(0), 0.25);
  EXPECT_EQ(named.place(1), 0.75);
  EXPECT_EQ(texts_of(named), (std::vector<std::string>{"a", "b"}));
}

TEST(PlotAxis, LeavesOutTicksOfVeryManyDecades) {
  EXPECT_EQ(
      texts_of(axis_of({2e-14, 4}, 1e-300)),
      (std::vector<std::string>{"1e-13", "1e-11", "1e-9", "1e-7", "1e-5", "1e-3", "0.1", "10"}));
}

TEST(PlotAxis, HasNoTickBelowWhereTheLaneBegins) {
  const PlotAxis axis = axis_of({0, 0});
  EXPECT_EQ(texts_of(axis).front(), "< 1e-9");
  EXPECT_EQ(texts_of(axis)[1], "1e-9");
}

TEST(PlotAxis, MarksRoundValuesBetweenTwo) {
  const PlotAxis axis = PlotAxis::between("title", -18.9, 18.9, short_text);
  EXPECT_EQ(texts_of(axis), (std::vector<std::string>{"-10", "0", "10"}));
  EXPECT_EQ(texts_of(PlotAxis::between("title", 0, 64, short_text)).front(), "0") << "not -0";
  EXPECT_DOUBLE_EQ(axis.place(-18.9), 0);
  EXPECT_DOUBLE_EQ(axis.place(0), 0.5);
  EXPECT_DOUBLE_EQ(axis.place(18.9), 1);
}

TEST(PlotAxis, GivesEachNineOfAQuantileTheSameRoom) {
  const PlotAxis axis = PlotAxis::quantiles("title", 1000);
  EXPECT_EQ(texts_of(axis), (std::vector<std::string>{"min", "50 %", "90 %", "99 %", "99.9 %"}));
  EXPECT_DOUBLE_EQ(axis.place(1), 0.05 / 1.1);
  EXPECT_DOUBLE_EQ(axis.place(10), 0.05 / 1.1 + 1 / 3.3);
  EXPECT_DOUBLE_EQ(axis.place(1000), 1.05 / 1.1);
  EXPECT_EQ(texts_of(PlotAxis::quantiles("title", 1)),
            (std::vector<std::string>{"min", "50 %", "90 %"}));
  EXPECT_EQ(texts_of(PlotAxis::quantiles("title", 8.6e9)),
            (std::vector<std::string>{"min", "99 %", "99.99 %", "99.9999 %", "99.999999 %"}));
}

// Where the axis has some powers of ten, 50 % is beside min.
TEST(PlotAxis, DropsOnNarrowPagesTheTextThatIsBesideAnother) {
  const PlotAxis axis = PlotAxis::quantiles("quantile", 3000);
  EXPECT_EQ(texts_of(axis), (std::vector<std::string>{"min", "50 %", "90 %", "99 %", "99.9 %"}));
  std::vector<std::string> kept;
  for (std::size_t i = 0; i < axis.ticks().size(); ++i)
    if (std::string(tick_class(axis, i)) == "tick") kept.push_back(axis.ticks()[i].text);
  EXPECT_EQ(kept, (std::vector<std::string>{"min", "90 %", "99 %", "99.9 %"}));
}

}  // namespace
}  // namespace planetree::tools
