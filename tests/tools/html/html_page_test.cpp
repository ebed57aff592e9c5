#include "tools/html/html_page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/html/html_counts.h"
#include "tools/html/html_table.h"

namespace planetree::tools {
namespace {

constexpr const char* kHostile = "</title></script><script>alert('x')</script><img src=x \"&\xFF";

TEST(HtmlPage, ForbidsItselfEveryRequest) {
  const std::string html = page_html({"kind", "title", paragraph_html("text"), {}});
  EXPECT_EQ(html.find("<!DOCTYPE html>"), 0u);
  EXPECT_EQ(count_of(html,
                     "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src "
                     "'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'\">"),
            1);
  for (const char* outside : {"http:", "https:", "src=", "href=", "url(", "@import", "fetch("})
    EXPECT_EQ(count_of(html, outside), 0) << outside;
}

TEST(HtmlPage, EscapesTextsFromOutside) {
  HtmlPage page{kHostile, kHostile, "", {}};
  page.body = paragraph_html(kHostile) + section_html(kHostile, "") +
              facts_html({kHostile, {{kHostile, kHostile}}}) + command_html(kHostile, kHostile);
  HtmlTable table{kHostile, {{"", kHostile}, {kHostile, kHostile}}, {}};
  table.rows.push_back({kHostile, true, kHostile, {kHostile, kHostile}});
  page.body += table_html(table);
  page.figures[kHostile] = {kHostile, {{kHostile, kHostile}}};
  const std::string html = page_html(page);
  EXPECT_EQ(count_of(html, "alert("),
            count_of(html, "&lt;script&gt;alert(") + count_of(html, "\\u003cscript\\u003ealert("));
  EXPECT_EQ(count_of(html, "<img"), 0);
  EXPECT_EQ(count_of(html, "<script"), 2) << "the figures and the script that shows them";
  EXPECT_EQ(count_of(html, "</script>"), 2);
  EXPECT_EQ(html.find('\xFF'), std::string::npos);
}

TEST(HtmlPage, CarriesTheFiguresOfPoints) {
  HtmlPage page{"kind", "title", "", {}};
  page.figures["a-1"] = {"exact", {{"queries a second", "1.2 M"}, {"broken", "0"}}};
  const std::string html = page_html(page);
  const std::string begin = "<script type=\"application/json\" id=\"figures\">";
  const std::size_t at = html.find(begin) + begin.size();
  const auto json = nlohmann::json::parse(html.substr(at, html.find("</script>", at) - at));
  EXPECT_EQ(json["a-1"]["title"], "exact");
  EXPECT_EQ(json["a-1"]["values"][0][1], "1.2 M");
}

TEST(HtmlTable, GroupsColumnsThatAreNeighbours) {
  HtmlTable table{"caption",
                  {{"", "name", HtmlColumn::Kind::kText},
                   {"error", "p50"},
                   {"error", "p99"},
                   {"", "options", HtmlColumn::Kind::kCode}},
                  {}};
  table.rows.push_back({"key", false, "", {"exact", "1", "2", "--max-work 8"}});
  table.rows.push_back({"", true, "dominated", {"work 8", "3", "4", "none"}});
  const std::string html = table_html(table);
  EXPECT_EQ(count_of(html, "colspan=\"2\"><span>error</span>"), 1);
  EXPECT_EQ(count_of(html, "rowspan=\"2\""), 2);
  EXPECT_EQ(count_of(html, "<td class=\"number\">"), 4);
  EXPECT_EQ(count_of(html, "<code>--max-work 8</code>"), 1);
  EXPECT_EQ(count_of(html, "<tr data-key=\"key\">"), 1);
  EXPECT_EQ(count_of(html, "work 8<span class=\"unseen\"> (dominated)</span>"), 1)
      << "grey is not all that tells it";
}

}  // namespace
}  // namespace planetree::tools
