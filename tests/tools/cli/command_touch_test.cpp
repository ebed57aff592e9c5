#include <gtest/gtest.h>

#include <string>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

using CommandTouch = Command;

TEST_F(CommandTouch, WritesAPageBesideItsReport) {
  const std::vector<std::string> session = {
      "touch", "tree.ptree", "--deterministic", "--seconds", "1", "--rate", "50"};
  const auto with = [&session](std::vector<std::string> more) {
    more.insert(more.begin(), session.begin(), session.end());
    return run(more);
  };
  const Outcome plain = with({}), result = with({"--html", "page.html"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.output, plain.output);
  const std::string page = text_of("page.html");
  EXPECT_NE(page.find("planetree touch tree.ptree --seconds 1 --rate 50 --deterministic "
                      "--html page.html --force"),
            std::string::npos);
  EXPECT_EQ(with({"--html", "page.html"}).status, 2) << "it exists";
  ASSERT_EQ(with({"--html", "page.html", "--force"}).status, 0);
  EXPECT_EQ(text_of("page.html"), page) << "a simulated session is the same each time";
  EXPECT_EQ(with({"--html", "tree.ptree", "--force"}).status, 2);
}

}  // namespace
}  // namespace planetree::tools
