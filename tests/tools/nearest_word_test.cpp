#include "tools/nearest_word.h"

#include <gtest/gtest.h>

namespace planetree::tools {
namespace {

const std::vector<std::string> kWords = {"--output", "--format", "--memory", "--force", "--json"};

TEST(NearestWord, UndoesOneSlip) {
  EXPECT_EQ(nearest_word("--ouput", kWords), "--output");
  EXPECT_EQ(nearest_word("--outpuut", kWords), "--output");
  EXPECT_EQ(nearest_word("--memroy", kWords), "--memory");
  EXPECT_EQ(nearest_word("--farce", kWords), "--force");
  EXPECT_EQ(nearest_word("-json", kWords), "--json");
}

TEST(NearestWord, PrefersTheNearest) {
  EXPECT_EQ(nearest_word("--formt", kWords), "--format");
  EXPECT_EQ(nearest_word("--forc", kWords), "--force");
  EXPECT_EQ(nearest_word("--force", kWords), "--force");
}

TEST(NearestWord, GuessesNothingFarAway) {
  EXPECT_EQ(nearest_word("--verbose", kWords), std::nullopt);
  EXPECT_EQ(nearest_word("-x", kWords), std::nullopt);
  EXPECT_EQ(nearest_word("", kWords), std::nullopt);
  EXPECT_EQ(nearest_word("--output", {}), std::nullopt);
  EXPECT_EQ(nearest_word(std::string(100'000, '-'), kWords), std::nullopt);
}

}  // namespace
}  // namespace planetree::tools
