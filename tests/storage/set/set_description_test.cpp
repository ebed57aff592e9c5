#include "storage/set/set_description.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "storage/set/member_address.h"

namespace planetree::storage {
namespace {

SetDescription sample_description() {
  SetDescription description;
  description.content_id = {0x0123456789abcdef, 0xfedcba9876543210};
  description.members.push_back({"a.000.part", 2048, {1, 2}, 0, {}});
  description.members.push_back({"folder/b \"c\".part",
                                 std::uint64_t{1} << 40,
                                 {3, ~std::uint64_t{0}},
                                 7,
                                 MemberBox{{-1.5, 0.1, -1e300}, {1, 2, 5e-324}}});
  return description;
}

Result<SetDescription> parse(const std::string& text) {
  return SetDescription::parse(std::as_bytes(std::span(text)));
}

std::string changed(const std::string& from, const std::string& to) {
  std::string text = sample_description().text();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

ErrorCode code_of(const std::string& text) {
  const auto description = parse(text);
  EXPECT_FALSE(description) << text;
  return description ? ErrorCode::kCancelled : description.error().code;
}

TEST(SetDescription, ReadsWhatItWrites) {
  const SetDescription written = sample_description();
  const auto read = parse(written.text());
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(read->content_id, written.content_id);
  EXPECT_EQ(read->bytes(), (std::uint64_t{1} << 40) + 2048);
  ASSERT_EQ(read->members.size(), 2u);
  EXPECT_EQ(read->members[1].address, "folder/b \"c\".part");
  EXPECT_EQ(read->members[1].hash, written.members[1].hash);
  EXPECT_EQ(read->members[1].pages, 7u);
  EXPECT_FALSE(read->members[0].box);
  ASSERT_TRUE(read->members[1].box);
  EXPECT_EQ(read->members[1].box->lower[2], -1e300);
  EXPECT_EQ(read->members[1].box->upper[2], 5e-324);
  EXPECT_EQ(read->text(), written.text());
}

TEST(SetDescription, ReadersIgnoreUnknownKeys) {
  EXPECT_TRUE(parse(changed("\"version\": 1,", "\"version\": 1, \"later\": {\"a\": [1]},")));
}

TEST(SetDescription, RefusesOtherTexts) {
  EXPECT_EQ(code_of(""), ErrorCode::kNotPlanetree);
  EXPECT_EQ(code_of("[]"), ErrorCode::kNotPlanetree);
  EXPECT_EQ(code_of("{\"format\": \"planetree-scene\"}"), ErrorCode::kNotPlanetree);
  EXPECT_EQ(code_of(changed("\"version\": 1", "\"version\": 2")), ErrorCode::kUnsupported);
  EXPECT_EQ(code_of(changed("\"version\": 1", "\"version\": \"1\"")), ErrorCode::kUnsupported);
  EXPECT_EQ(code_of(std::string(2 << 20, '[')), ErrorCode::kNotPlanetree);
}

TEST(SetDescription, RefusesValuesThatAreNone) {
  const std::pair<const char*, const char*> changes[] = {
      {"fedcba9876543210", "fedcba987654321"},
      {"fedcba9876543210", "gedcba9876543210"},
      {"\"bytes\":2048", "\"bytes\":2049"},
      {"\"bytes\":2048", "\"bytes\":-1"},
      {"\"bytes\":2048", "\"bytes\":0"},
      {"\"bytes\":2048", "\"bytes\":9007199254740993"},
      {"\"bytes\":2048", "\"bytes\":1e3"},
      {"\"bytes\":2048", "\"bytes\":18446744073709551615"},
      {"\"pages\":7", "\"pages\":4294967296"},
      {"\"pages\":7", "\"pages\":null"},
      {"\"a.000.part\"", "\"\""},
      {"\"a.000.part\"", "\"a\\u0000b\""},
      {"\"a.000.part\"", "\"a\\nb\""},
      {"\"a.000.part\"", "7"},
      {"[-1.5,0.1,-1e+300]", "[-1.5,0.1]"},
      {"[-1.5,0.1,-1e+300]", "[-1.5,0.1,\"x\"]"},
      {"[-1.5,0.1,-1e+300]", "[-1.5,0.1,1e999]"},
      {"\"members\": [", "\"memberz\": ["},
  };
  for (const auto& [from, to] : changes) {
    const ErrorCode code = code_of(changed(from, to));
    // A number beyond all doubles is no JSON for some readers.
    EXPECT_TRUE(code == ErrorCode::kDamaged || std::string(to).find("1e999") != std::string::npos)
        << from << " " << to;
  }
}

TEST(SetDescription, RefusesTooManyMembers) {
  SetDescription description = sample_description();
  description.members.resize(SetDescription::kMaxMembers, description.members.front());
  EXPECT_TRUE(parse(description.text()));
  description.members.push_back(description.members.front());
  EXPECT_EQ(code_of(description.text()), ErrorCode::kDamaged);
  description.members.clear();
  EXPECT_EQ(code_of(description.text()), ErrorCode::kDamaged);
}

TEST(SetDescription, SurvivesRandomChanges) {
  std::mt19937 random(5);
  const std::string text = sample_description().text();
  unsigned refused = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string copy = text;
    for (auto change = random() % 3 + 1; change-- > 0;) {
      const std::size_t at = random() % copy.size();
      if (random() % 4 == 0)
        copy.erase(at, random() % 9 + 1);
      else
        copy[at] = static_cast<char>(random() % 256);
      if (copy.empty()) break;
    }
    const auto description = parse(copy);
    refused += description ? 0 : 1;
    if (!description) continue;
    EXPECT_LE(description->members.size(), SetDescription::kMaxMembers);
    EXPECT_TRUE(parse(description->text())) << copy;
  }
  EXPECT_GT(refused, 10'000u);
}

TEST(SetNames, EndInThePtreesetExtension) {
  EXPECT_TRUE(is_set_name("a.ptreeset"));
  EXPECT_TRUE(is_set_name("/folder/A.PtreeSet"));
  EXPECT_TRUE(is_set_name("https://host/a.ptreeset?signature=a.ptree"));
  EXPECT_FALSE(is_set_name("https://host/a.ptree?name=a.ptreeset"));
  EXPECT_FALSE(is_set_name("a.ptree"));
  EXPECT_FALSE(is_set_name("ptreeset"));
  EXPECT_FALSE(is_set_name(".ptreeset"));
}

TEST(MemberPaths, LeadFromTheRecord) {
  const auto path = [](const char* set, const char* address) {
    const auto found = member_path(set, address);
    return found ? found->string() : std::string("refused");
  };
  EXPECT_EQ(path("a.ptreeset", "a.0.part"), "a.0.part");
  EXPECT_EQ(path("/x/a.ptreeset", "y/a.0.part"), "/x/y/a.0.part");
  EXPECT_EQ(path("/x/a.ptreeset", "/y/a.0.part"), "/y/a.0.part");
  EXPECT_EQ(path("/x/a.ptreeset", "http://h/a.0.part"), "http://h/a.0.part");
  EXPECT_EQ(path("http://h/x/a.ptreeset?s=/1", "y/a b.part"), "http://h/x/y/a%20b.part");
  EXPECT_EQ(path("http://h/x/a.ptreeset", "https://i/z"), "https://i/z");
}

// A server decides neither about files of this machine nor about others of its own.
TEST(MemberPaths, OfAServerStayInItsFolder) {
  for (const char* address : {"/etc/passwd", "../a", "x/../../a", "file:///etc/passwd"}) {
    const auto path = member_path("http://h/x/a.ptreeset", address);
    if (path) {
      EXPECT_TRUE(path->string().starts_with("http://h/x/")) << address;
      EXPECT_EQ(path->string().find(".."), std::string::npos) << address;
    } else {
      EXPECT_EQ(path.error().code, ErrorCode::kUnsupported);
    }
  }
}

}  // namespace
}  // namespace planetree::storage
