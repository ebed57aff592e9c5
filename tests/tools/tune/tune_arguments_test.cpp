#include "tools/tune/tune_arguments.h"

#include <gtest/gtest.h>

namespace planetree::tools {
namespace {

TEST(TuneArguments, ReadPageSizes) {
  const auto sizes = parse_page_sizes("16K,64K,256K");
  ASSERT_TRUE(sizes);
  EXPECT_EQ(*sizes, (std::vector<std::uint64_t>{16384, 65536, 262144}));
  for (const char* text : {"", "16K,", ",16K", "2K", "512K", "24K", "64K 256K", "x"})
    EXPECT_FALSE(parse_page_sizes(text)) << text;
}

TEST(TuneArguments, AreTheCommandThatMakesThePageAgain) {
  TuneArguments arguments;
  arguments.traces = {"a b.trace", "c.trace"};
  arguments.page.html = "out.html";
  EXPECT_EQ(tune_command(arguments), "planetree tune 'a b.trace' c.trace --html out.html --force");
  arguments.goal_text = "degraded<0.1%";
  arguments.goal = *TuneGoal::parse(arguments.goal_text);
  arguments.latency_ns = 85'000;
  arguments.page_sizes = {16384, 262144};
  arguments.model = "m.ptree";
  EXPECT_EQ(tune_command(arguments),
            "planetree tune 'a b.trace' c.trace --model m.ptree --recommend 'degraded<0.1%' "
            "--latency 85000ns --pages 16384,262144 --html out.html --force");
}

}  // namespace
}  // namespace planetree::tools
