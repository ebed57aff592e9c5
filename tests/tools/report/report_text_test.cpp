#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>

#include "octree/geometry/octcode.h"
#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/check/sample_tree.h"
#include "tests/tools/cli/captured_console.h"
#include "tools/check/issue.h"
#include "tools/cli/file_digest.h"
#include "tools/cli/file_text.h"
#include "tools/cli/open_model.h"

namespace planetree::tools {
namespace {

TEST(Octcode, ParsesTheTextItIsShownAs) {
  for (const unsigned bits : {0u, 1u, 5u, 23u, 56u, 57u}) {
    const std::uint64_t octcode =
        octree::octcode_of_prefix(octree::morton_code(0x5a5a5, 0x12345, 0x7ffff), bits);
    const auto query = OctcodeQuery::parse(cell_text(octcode));
    ASSERT_TRUE(query) << cell_text(octcode);
    EXPECT_TRUE(query->matches(octcode));
    EXPECT_FALSE(query->matches(octcode ^ (std::uint64_t{1} << 59)));
  }
  EXPECT_TRUE(OctcodeQuery::parse("0:0:0:0")->matches(2));
  EXPECT_FALSE(OctcodeQuery::parse("0:0:0:0+1")->matches(2));
  EXPECT_TRUE(OctcodeQuery::parse("0x1040000000000001")->matches(0x1040000000000001));
}

TEST(Octcode, RefusesMalformedOctcodes) {
  for (const char* text : {"", "0x", "0xg", "0x11111111111111111", "1:2:3", "1:2:3:", "1:2:3:4:5",
                           "20:0:0:0", "-1:0:0:0", "1:2:3:4+3", "1:2:3:4+", "a:b:c:d", "1;2;3;4"})
    EXPECT_FALSE(OctcodeQuery::parse(text)) << text;
}

TEST(FileDigest, IsSha256) {
  storage::TemporaryDirectory folder;
  std::ofstream(folder / "abc") << "abc";
  const auto digest = sha256_of_file(folder / "abc");
  ASSERT_TRUE(digest);
  EXPECT_EQ(*digest, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_FALSE(sha256_of_file(folder / "none"));
}

TEST(Issue, HasANameForEveryCode) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kIssueCodeCount; ++i)
    names.insert(issue_name(static_cast<IssueCode>(i)));
  EXPECT_EQ(names.size(), kIssueCodeCount);
}

// Every code is documented.
TEST(Issue, EveryCodeIsDocumented) {
  std::ifstream stream(std::string(PLANETREE_SOURCE_DIR) + "/format-spec/ISSUES.md");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  for (std::size_t i = 0; i < kIssueCodeCount; ++i) {
    const std::string row = "| `" + std::string(issue_name(static_cast<IssueCode>(i))) + "` |";
    EXPECT_NE(text.find(row), std::string::npos) << row;
  }
}

TEST(ErrorLine, IsOneLineWhateverTheName) {
  Error error = make_error(ErrorCode::kDamaged, 3, 4096, "it is wrong; mend it");
  EXPECT_EQ(error_line("a\nb", error),
            "planetree: a?b: page 3, at byte 4096: it is wrong; mend it\n");
  error.page = Error::kNowhere;
  EXPECT_EQ(error_line("a", error), "planetree: a: at byte 4096: it is wrong; mend it\n");
}

TEST(ErrorLine, NamesAPositionOnce) {
  for (const char* text :
       {"byte 80: the count is wrong", "line 7: 'x' is no number", "byte 4096: it is damaged"})
    EXPECT_EQ(error_line("a", make_error(ErrorCode::kBadInput, Error::kNowhere, 80, "%s", text)),
              std::string("planetree: a: ") + text + "\n");
  EXPECT_EQ(error_line("a", make_error(ErrorCode::kBadInput, Error::kNowhere, 80, "bytes lack")),
            "planetree: a: at byte 80: bytes lack\n");
}

TEST(PagesLost, ReportsUnreadablePagesBeforeTimeouts) {
  Stats stats;
  EXPECT_EQ(pages_lost(stats, {}), std::nullopt);
  stats.waits_given_up = 3;
  stats.degraded_answers = 5;
  const auto late = pages_lost(stats, {});
  ASSERT_TRUE(late);
  EXPECT_EQ(exit_status(late->code), 3);
  EXPECT_TRUE(
      std::string(late->text).starts_with("3 waits for its pages reached the limit, so 5 "));
  stats.quarantined_pages = 1;
  const auto unreadable = pages_lost(stats, {});
  ASSERT_TRUE(unreadable);
  EXPECT_EQ(exit_status(unreadable->code), 1);
  EXPECT_TRUE(std::string(unreadable->text).starts_with("1 of its pages cannot be read, so 5 "));
}

TEST(ExitStatus, SeparatesDataCommandLineAndMachine) {
  EXPECT_EQ(exit_status(ErrorCode::kBadArgument), 2);
  EXPECT_EQ(exit_status(ErrorCode::kNotFound), 2);
  EXPECT_EQ(exit_status(ErrorCode::kAlreadyExists), 2);
  for (const ErrorCode code : {ErrorCode::kPermission, ErrorCode::kNoSpace, ErrorCode::kNoMemory,
                               ErrorCode::kReadFailed, ErrorCode::kWriteFailed})
    EXPECT_EQ(exit_status(code), 3);
  for (const ErrorCode code : {ErrorCode::kBadInput, ErrorCode::kNotPlanetree,
                               ErrorCode::kUnsupported, ErrorCode::kTruncated, ErrorCode::kDamaged})
    EXPECT_EQ(exit_status(code), 1);
}

}  // namespace
}  // namespace planetree::tools
