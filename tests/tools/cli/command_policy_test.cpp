#include <gtest/gtest.h>

#include <string>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

constexpr const char* kPolicies[] = {"clock", "lru", "sieve", "s3fifo", "2q"};

/// The option --policy of the subcommands.
class PolicyOption : public Command {
 protected:
  // Points all over the mesh, so that little memory does not hold all pages.
  static std::string points() {
    std::string text;
    for (int i = 0; i < 400; ++i)
      text += std::to_string(i * 37 % 101) + ',' + std::to_string(i * 53 % 97) + ",1\n";
    return text;
  }
};

TEST_F(PolicyOption, LeavesAnswersAsTheyAre) {
  const std::string refused = run({"query", "tree.ptree", "--memory", "1"}, points()).errors;
  const auto at = refused.find("at least ");
  ASSERT_NE(at, std::string::npos) << refused;
  const std::string least = std::to_string(std::stoull(refused.substr(at + 9)) + 8192);
  const std::string expected = run({"query", "tree.ptree"}, points()).output;
  for (const char* policy : kPolicies) {
    const Outcome result =
        run({"query", "tree.ptree", "--policy", policy, "--memory", least}, points());
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_EQ(result.output, expected) << policy;
  }
}

TEST_F(PolicyOption, IsReportedBySessions) {
  const auto session = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"touch", "tree.ptree", "--json", "--seconds", "1", "--rate", "20"});
    return Json::parse(run(more).output);
  };
  EXPECT_EQ(session({})["policy"], "clock");
  EXPECT_EQ(session({"--policy", "s3fifo"})["policy"], "s3fifo");
}

TEST_F(PolicyOption, RefusesAnUnknownPolicyAndListsTheKnownOnes) {
  for (const char* subcommand : {"query", "touch"}) {
    const Outcome result = run({subcommand, "tree.ptree", "--policy", "fifo"});
    EXPECT_EQ(result.status, 2);
    for (const char* policy : kPolicies)
      EXPECT_NE(result.errors.find(policy), std::string::npos) << result.errors;
  }
}

}  // namespace
}  // namespace planetree::tools
