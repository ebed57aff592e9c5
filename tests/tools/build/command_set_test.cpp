#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

/// A statue of about 600 KB as a file and as a set.
class CommandSet : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    ASSERT_EQ(run({"generate", "big.ply", "--triangles", "60000"}).status, 0);
    const Outcome one = run({"build", "big.ply", "-o", "one.ptree", "--json"});
    ASSERT_EQ(one.status, 0) << one.errors;
    one_ = Json::parse(one.output);
    const Outcome built =
        run({"build", "big.ply", "-o", "set.ptreeset", "--set", "--member-size", "64K", "--json"});
    ASSERT_EQ(built.status, 0) << built.errors;
    set_ = Json::parse(built.output);
    members_ = Json::parse(text_of("set.ptreeset"))["members"];
  }
  fs::path member(std::size_t number) const { return members_[number]["address"]; }
  std::string joined(const char* set) const {
    const Json description = Json::parse(text_of(set));
    std::string bytes;
    for (const Json& member : description["members"])
      bytes += text_of(member["address"].get<std::string>());
    return bytes;
  }
  static void expect_refused(const Outcome& outcome, const std::string& part) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  }

  Json one_, set_, members_;
};

TEST_F(CommandSet, IsTheFileInParts) {
  EXPECT_GE(members_.size(), 8u);
  EXPECT_TRUE(joined("set.ptreeset") == text_of("one.ptree"));
  for (const char* key : {"sha256", "content_id", "file_bytes", "triangles"})
    EXPECT_EQ(set_[key], one_[key]) << key;
}

TEST_F(CommandSet, IsWhatMergeWrites) {
  ASSERT_EQ(run({"shard", "plan", "big.ply", "-o", "job", "--shards", "2"}).status, 0);
  for (const char* step : {"map", "reduce"})
    for (const char* number : {"0", "1"}) ASSERT_EQ(run({"shard", step, "job", number}).status, 0);
  const Outcome merged = run(
      {"shard", "merge", "job", "-o", "set.ptreeset", "--set", "--member-size", "100K", "--force"});
  ASSERT_EQ(merged.status, 0) << merged.errors;
  EXPECT_TRUE(joined("set.ptreeset") == text_of("one.ptree"));
  // The members of the set that was replaced are gone, also where they were more.
  EXPECT_FALSE(fs::exists(member(members_.size() - 1)));
  expect_refused(run({"shard", "map", "job", "0", "--set"}), "--set is for merge");
}

TEST_F(CommandSet, AnswersAsTheFile) {
  write("points.csv", "x,y,z\n1,2,3\n95,3,0.5\n-99,3,-4\n7,80,90\n-20,-90,-60\n-70,-60,50\n");
  const Outcome of_file = run({"query", "one.ptree", "points.csv"});
  const Outcome of_set = run({"query", "set.ptreeset", "points.csv"});
  EXPECT_EQ(of_set.status, 0) << of_set.errors;
  EXPECT_EQ(of_set.output, of_file.output);
}

TEST_F(CommandSet, IsVerified) {
  const Outcome sound = run({"verify", "set.ptreeset", "--full"});
  EXPECT_EQ(sound.status, 0) << sound.output;
  flip(member(3), 100);
  const Outcome damaged = run({"verify", "set.ptreeset", "--full", "--json"});
  EXPECT_EQ(damaged.status, 1);
  const Json issues = Json::parse(damaged.output)["issues"];
  EXPECT_EQ(issues[0]["code"], "SET");
  EXPECT_NE(issues[0]["message"].get<std::string>().find(member(3).string()), std::string::npos);
  EXPECT_TRUE(std::any_of(issues.begin(), issues.end(),
                          [](const Json& issue) { return issue["code"] == "PAGE_CHECKSUM"; }));
}

TEST_F(CommandSet, IsVerifiedAgainstItsRecord) {
  const std::string text = text_of("set.ptreeset");
  const auto issues_of = [](const std::string& description) {
    write("set.ptreeset", description);
    return Json::parse(run({"verify", "set.ptreeset", "--json"}).output)["issues"];
  };
  Json other_id = Json::parse(text);
  other_id["content_id"] = std::string(32, '0');
  ASSERT_EQ(issues_of(other_id.dump()).size(), 1u);
  EXPECT_EQ(issues_of(other_id.dump())[0]["code"], "SET");
  Json other_pages = Json::parse(text);
  other_pages["members"][1]["pages"] = members_[1]["pages"].get<int>() - 1;
  other_pages["members"][2]["pages"] = members_[2]["pages"].get<int>() + 1;
  ASSERT_EQ(issues_of(other_pages.dump()).size(), 1u);
  EXPECT_EQ(issues_of(other_pages.dump())[0]["code"], "SET");
  Json fewer = Json::parse(text);
  fewer["members"].back()["pages"] = 0;
  EXPECT_FALSE(issues_of(fewer.dump()).empty());
  EXPECT_TRUE(issues_of(text).empty());
}

TEST_F(CommandSet, IsInspected) {
  const Json report = Json::parse(run({"inspect", "set.ptreeset", "--json"}).output);
  ASSERT_EQ(report["members"].size(), members_.size());
  EXPECT_EQ(report["triangles"], one_["triangles"]);
  EXPECT_TRUE(report["members"][0]["layers"].empty());
  EXPECT_EQ(report["members"][1]["layers"][0], "distance");
  EXPECT_TRUE(report["members"][1]["box"].is_array());
  EXPECT_TRUE(report["members"][1]["fault"].is_null());
  std::uint64_t pages = 0;
  for (const Json& member : report["members"]) pages += member["pages"].get<std::uint64_t>();
  EXPECT_EQ(pages, report["pages"].get<std::uint64_t>());
  const Outcome text = run({"inspect", "set.ptreeset"});
  EXPECT_NE(text.output.find("member 1    " + member(1).string()), std::string::npos);
  // A file has no members.
  EXPECT_FALSE(Json::parse(run({"inspect", "one.ptree", "--json"}).output).contains("members"));
}

TEST_F(CommandSet, MayLackMembersIfToldSo) {
  fs::remove(member(3));
  write("points.csv", "x,y,z\n1,2,3\n95,3,0.5\n-99,3,-4\n7,80,90\n-20,-90,-60\n-70,-60,50\n");
  expect_refused(run({"query", "set.ptreeset", "points.csv"}), member(3).string());
  const Outcome partial = run({"query", "set.ptreeset", "points.csv", "--allow-missing"});
  EXPECT_NE(partial.output.find(",exact"), std::string::npos) << partial.output;
  const Outcome inspected = run({"inspect", "set.ptreeset", "--json"});
  EXPECT_EQ(inspected.status, 1);
  const Json report = Json::parse(inspected.output);
  EXPECT_FALSE(report["members"][3]["fault"].is_null());
  EXPECT_EQ(report["issues"][0]["code"], "SET");
}

TEST_F(CommandSet, TellsMissingMembersFromDamagedOnes) {
  fs::remove(member(3));
  fs::resize_file(member(2), 100);
  const std::string text = run({"inspect", "set.ptreeset"}).output;
  const auto line = [&text](const char* member) {
    const std::size_t at = text.find(member);
    return text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_TRUE(line("member 3 ").ends_with("; missing")) << text;
  EXPECT_TRUE(line("member 2 ").ends_with("; damaged")) << text;
  EXPECT_EQ(line("member 1 ").find("; missing"), std::string::npos);
  EXPECT_EQ(line("member 1 ").find("; damaged"), std::string::npos);
}

TEST_F(CommandSet, RefusesNamesAndSizes) {
  expect_refused(run({"build", "big.ply", "-o", "new.ptree", "--set"}), "OUT.ptreeset");
  expect_refused(run({"build", "big.ply", "-o", "new.ptreeset"}), "give --set too");
  expect_refused(run({"build", "big.ply", "-o", "new.ptreeset", "--set", "--member-size", "63K"}),
                 "64K or more");
  expect_refused(run({"build", "big.ply", "-o", "new.ptree", "--member-size", "1M"}), "--set");
  expect_refused(run({"build", "big.ply", "-o", "set.ptreeset", "--set"}), "exists");
  write("other.ptreeset", "{}");
  const Outcome other = run({"inspect", "other.ptreeset"});
  EXPECT_NE(other.status, 0);
  EXPECT_NE(other.errors.find("not a set file"), std::string::npos) << other.errors;
}

}  // namespace
}  // namespace planetree::tools
