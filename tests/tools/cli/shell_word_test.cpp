#include "tools/cli/shell_word.h"

#include <gtest/gtest.h>

namespace planetree::tools {
namespace {

TEST(ShellWord, QuotesOnlyWhatTheShellWouldChange) {
  EXPECT_EQ(shell_word("scan-1/a_b.ptree"), "scan-1/a_b.ptree");
  EXPECT_EQ(shell_word("my scan.ptree"), "'my scan.ptree'");
  EXPECT_EQ(shell_word("$(rm)"), "'$(rm)'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
  EXPECT_EQ(shell_word("~a"), "'~a'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace planetree::tools
