#include "tools/trade/trade_setting.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace planetree::tools {
namespace {

TEST(TradeSettings, BeginWithExactAnswersAndHaveEachKind) {
  const auto settings = trade_settings(100, 0.5, 1 << 20, 1 << 24);
  ASSERT_FALSE(settings.empty());
  EXPECT_TRUE(settings.front().is_exact());
  const auto has = [&](auto test) { return std::any_of(settings.begin(), settings.end(), test); };
  for (const double error : {1e-3, 0.01, 0.1, 0.5, 1.0, 5.0, 10.0})
    EXPECT_TRUE(has([error](const TradeSetting& s) {
      return s.max_error <= error && s.max_error > 0.99 * error;
    })) << error;
  EXPECT_TRUE(has([](const TradeSetting& s) { return s.max_work == 64; }));
  EXPECT_TRUE(has(
      [](const TradeSetting& s) { return s.wait == Wait::kNever && s.memory_bytes == 1 << 22; }));
  EXPECT_EQ(std::count_if(settings.begin(), settings.end(),
                          [](const TradeSetting& s) { return s.is_exact(); }),
            1);
}

TEST(TradeSettings, HaveErrorsOfFewDigits) {
  for (const TradeSetting& setting : trade_settings(1.0 / 3, 0.0123456789, 1 << 20, 1 << 24))
    EXPECT_LT(setting.options().size(), std::string("--max-error 0.00000331").size() + 14);
}

TEST(TradeSetting, NamesTheOptionsOfQuery) {
  TradeSetting setting;
  EXPECT_EQ(setting.options(), "");
  setting.max_error = 0.25;
  EXPECT_EQ(setting.options(), "--max-error 0.25");
  setting.max_work = 64;
  setting.wait = Wait::kNever;
  setting.memory_bytes = 4096;
  EXPECT_EQ(setting.options(), "--max-error 0.25 --max-work 64 --never-wait --memory 4096");
}

}  // namespace
}  // namespace planetree::tools
