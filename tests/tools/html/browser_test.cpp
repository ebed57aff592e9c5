// The browser of the tests sees what a page must not do.

#include "tests/tools/html/browser.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/storage/system/temporary_directory.h"
#include "tools/html/html_page.h"

namespace planetree::tools {
namespace {

class BrowserVisits : public testing::Test {
 protected:
  void SetUp() override {
    if (!Browser::is_here()) GTEST_SKIP() << Browser::kMissing;
  }
  BrowserVisit visit(const std::string& body, const std::string& examination = "return 1") {
    return Browser::visit(page_html({"kind", "title", body, {}}), examination, {}, folder_ / ".");
  }

  storage::TemporaryDirectory folder_;
};

TEST_F(BrowserVisits, FindNothingInAPageThatDoesNothing) {
  const BrowserVisit quiet = visit("<p>text</p>", "return document.querySelector('h1').innerText");
  EXPECT_EQ(quiet.report, "title");
  EXPECT_TRUE(quiet.complaints.empty()) << quiet.complaints.front();
  EXPECT_TRUE(quiet.requests.empty()) << quiet.requests.front();
}

TEST_F(BrowserVisits, SeeErrorsOfScripts) {
  EXPECT_EQ(visit("<script>none.such()</script>").complaints.size(), 1u);
  EXPECT_EQ(visit("<script>console.error('x')</script>").complaints.size(), 1u);
  EXPECT_EQ(visit("", "none.such()").complaints.size(), 1u);
}

TEST_F(BrowserVisits, SeeRequestsThatThePolicyStops) {
  EXPECT_GE(visit("<img src=\"https://127.0.0.1:9/x.png\">").complaints.size(), 1u);
  EXPECT_GE(visit("<script src=\"https://127.0.0.1:9/x.js\"></script>").complaints.size(), 1u);
  EXPECT_GE(visit("<style>@import 'https://127.0.0.1:9/x.css'</style>").complaints.size(), 1u);
}

TEST_F(BrowserVisits, SeeRequestsThatNoPolicyStops) {
  std::string html = page_html({"kind", "title", "<img src=\"http://127.0.0.1:9/x.png\">", {}});
  const std::string none = "default-src 'none'";
  html.replace(html.find(none), none.size(), "default-src *");
  EXPECT_GE(Browser::visit(html, "return 1", {}, folder_ / ".").requests.size(), 1u);
}

}  // namespace
}  // namespace planetree::tools
