#include "tools/html/html_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

namespace planetree::tools {
namespace {

TEST(HtmlText, EscapesWhatEndsAnElementOrAnAttribute) {
  EXPECT_EQ(html_text(R"(a<b>&"c'd)"), "a&lt;b&gt;&amp;&quot;c&#39;d");
  EXPECT_EQ(html_text("na\xC3\xAFve \xE2\x82\xAC \xF0\x9F\x8C\xB3"),
            "na\xC3\xAFve \xE2\x82\xAC \xF0\x9F\x8C\xB3");
}

TEST(HtmlText, ReplacesControlCharactersAndBytesThatAreNotUtf8) {
  const std::string replacement = "\xEF\xBF\xBD";
  for (const char* bytes : {"\x01", "\n", "\x7F", "\x80", "\xC0", "\xFF", "\xF5"})
    EXPECT_EQ(html_text(std::string("a") + bytes + "b"), "a" + replacement + "b");
  EXPECT_EQ(html_text("\xC3"), replacement) << "cut off";
  EXPECT_EQ(html_text("\xC3<"), replacement + "&lt;") << "what follows is not lost";
  EXPECT_EQ(html_text("\xED\xA0\x80"), replacement + replacement + replacement) << "a surrogate";
  EXPECT_EQ(html_text("\xE0\x80\xBC"), replacement + replacement + replacement) << "too long";
}

TEST(ScriptJson, HasNothingThatEndsTheScript) {
  const nlohmann::ordered_json value = {{"name", "</script><!--&\xE2\x80\xA8\xFF"}};
  const std::string text = script_json(value);
  EXPECT_EQ(text.find_first_of("<>&"), std::string::npos);
  for (const char c : text) EXPECT_TRUE(c >= 0x20 && c < 0x7F);
  EXPECT_EQ(nlohmann::json::parse(text)["name"], "</script><!--&\xE2\x80\xA8\xEF\xBF\xBD");
}

TEST(NumberText, HasThreeDigits) {
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(0.0123456), "0.0123");
  EXPECT_EQ(number_text(45.67), "45.7");
  EXPECT_EQ(number_text(7890.4), "7890");
  EXPECT_EQ(number_text(1.234e-5), "1.23e-5");
  EXPECT_EQ(number_text(1e-5), "1e-5");
  EXPECT_EQ(number_text(2e+12), "2e12");
  EXPECT_EQ(number_text(-0.5), "-0.500");
}

TEST(NumberText, HasPowersOfTenAsPeopleWriteThem) {
  EXPECT_EQ(power_text(0), "0");
  EXPECT_EQ(power_text(0.00001), "1.0e-5");
  EXPECT_EQ(power_text(3.68e-15), "3.7e-15");
  EXPECT_EQ(power_text(12), "1.2e1");
  EXPECT_EQ(short_text(0.001), "1e-3");
  EXPECT_EQ(short_text(0.05), "0.05");
  EXPECT_EQ(short_text(1.5), "1.5");
  EXPECT_EQ(short_text(100), "100");
  EXPECT_EQ(short_power_text(0.05), "5e-2");
  EXPECT_EQ(short_power_text(3.1e-3), "3.1e-3");
  EXPECT_EQ(short_power_text(1), "1");
}

}  // namespace
}  // namespace planetree::tools
