#include "tools/tune/tune_goal.h"

#include <gtest/gtest.h>

#include <string>

namespace planetree::tools {
namespace {

using Quantity = TuneGoal::Quantity;

TEST(TuneGoal, ReadsEachQuantity) {
  const auto is = [](const char* text, Quantity quantity, double limit) {
    const auto goal = TuneGoal::parse(text);
    return goal && goal->quantity == quantity && std::abs(goal->limit - limit) < 1e-12 * limit;
  };
  EXPECT_TRUE(is("degraded<0.1%", Quantity::kDegraded, 0.001));
  EXPECT_TRUE(is(" degraded < 0.1 % ", Quantity::kDegraded, 0.001));
  EXPECT_TRUE(is("degraded<0.001", Quantity::kDegraded, 0.001));
  EXPECT_TRUE(is("width<2.5e-3", Quantity::kWidth, 0.0025));
  EXPECT_TRUE(is("ticks<3", Quantity::kTicksToExact, 3));
  EXPECT_TRUE(is("misses<0.05", Quantity::kMisses, 0.05));
}

TEST(TuneGoal, RefusesOthersInOneLine) {
  for (const char* text : {"", "degraded", "degraded>1%", "degraded<", "degraded<x", "degraded<0",
                           "degraded<-1", "degraded<inf", "degraded<nan", "width<1%", "late<1",
                           "degraded<1%%", "degraded<1 2", "<1"}) {
    const auto goal = TuneGoal::parse(text);
    ASSERT_FALSE(goal) << text;
    EXPECT_EQ(goal.error().code, ErrorCode::kBadArgument);
    EXPECT_EQ(std::string(goal.error().text).find('\n'), std::string::npos);
  }
}

TEST(TuneGoal, WritesValuesForPeople) {
  EXPECT_EQ(text_of(Quantity::kDegraded, 0.00123), "0.123 %");
  EXPECT_EQ(text_of(Quantity::kTicksToExact, 3), "3");
  EXPECT_STREQ(name_of(Quantity::kTicksToExact), "ticks");
}

}  // namespace
}  // namespace planetree::tools
