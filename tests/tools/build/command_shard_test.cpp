#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

class CommandShard : public Command {
 protected:
  static Outcome shard(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "shard");
    return run(arguments);
  }
  static Outcome plan(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"plan", "mesh.obj",    "-o", "job",    "--shards",
                                       "2",    "--page-size", "4K", "--meta", "generator="};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return shard(arguments);
  }
  static void expect_refused(const Outcome& outcome, const std::string& part) {
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(outcome.errors.starts_with("planetree: shard: ")) << outcome.errors;
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  }
};

TEST_F(CommandShard, WritesTheFileThatBuildWrites) {
  ASSERT_EQ(plan().status, 0);
  for (const char* step : {"map", "reduce"})
    for (const char* number : {"0", "1"}) {
      const Outcome done = shard({step, "job", number});
      EXPECT_EQ(done.status, 0) << done.errors;
      EXPECT_TRUE(done.output.starts_with(std::string("job/") + step + "-" + number + ": "));
    }
  const Outcome merged = shard({"merge", "job", "-o", "new.ptree", "--json"});
  EXPECT_EQ(merged.status, 0) << merged.errors;
  EXPECT_EQ(storage::read_bytes("new.ptree"), storage::read_bytes("tree.ptree"));
  const Json report = Json::parse(merged.output);
  EXPECT_EQ(report["triangles"], kTriangles);
  EXPECT_EQ(report["page_bytes"], 4096);
  EXPECT_FALSE(report["seconds_by_phase"].contains("reading"));
}

TEST_F(CommandShard, TellsWhatAPlanTakes) {
  const Outcome planned = plan({"--json"});
  ASSERT_EQ(planned.status, 0) << planned.errors;
  const Json report = Json::parse(planned.output);
  EXPECT_EQ(report["step"], "plan");
  EXPECT_EQ(report["shards"], 2);
  EXPECT_EQ(report["triangles"], kTriangles);
  std::uint64_t sorted = 0;
  for (const char* number : {"0", "1"}) {
    const Json mapped = Json::parse(shard({"map", "job", number, "--json"}).output);
    EXPECT_EQ(mapped["shard"], std::stoi(number));
    EXPECT_FALSE(mapped["was_done"]);
    sorted += mapped["bytes"].get<std::uint64_t>();
    EXPECT_TRUE(Json::parse(shard({"map", "job", number, "--json"}).output)["was_done"]);
  }
  // The maximum: records are packed.
  EXPECT_GT(report["sorted_bytes"], sorted);
  EXPECT_GT(sorted, 0u);
  EXPECT_NE(plan().output.find("planned before"), std::string::npos);
  EXPECT_NE(shard({"map", "job", "0"}).output.find("done before"), std::string::npos);
}

TEST_F(CommandShard, RefusesArgumentsOfOtherSteps) {
  expect_refused(shard({"plan", "mesh.obj", "--shards", "2"}), "plan needs -o JOB");
  expect_refused(shard({"plan", "mesh.obj", "-o", "job"}), "plan needs --shards N");
  expect_refused(plan({"--force"}), "--force is for merge");
  expect_refused(shard({"map", "job"}), "map needs the number of a shard");
  expect_refused(shard({"map", "job", "0", "1"}), "map takes one job and the number of one shard");
  expect_refused(shard({"map", "job", "first"}), "is not a count");
  expect_refused(shard({"reduce", "job", "16384"}), "16384 is too large for a shard");
  expect_refused(shard({"map", "job", "0", "-o", "x"}), "leave out -o");
  expect_refused(shard({"map", "job", "0", "--shards", "2"}), "--shards is for plan");
  expect_refused(shard({"reduce", "job", "0", "--keep", "color"}), "decided by plan");
  expect_refused(shard({"merge", "job"}), "merge needs -o OUT.ptree");
  expect_refused(shard({"merge", "job", "1", "-o", "x"}), "merge takes no number");
  expect_refused(shard({"split", "job"}), "split");
}

TEST_F(CommandShard, NamesTheFileOfAnError) {
  Outcome outcome = shard({"map", "job", "0"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(
      outcome.errors.starts_with("planetree: job/plan: no plan; run 'planetree shard plan "))
      << outcome.errors;
  ASSERT_EQ(plan().status, 0);
  outcome = shard({"map", "job", "2"});
  EXPECT_NE(outcome.errors.find("there is no shard 2; the plan has 2, from 0 to 1"),
            std::string::npos)
      << outcome.errors;
  write_mesh("mesh.obj", kSide - 1);
  outcome = shard({"map", "job", "0"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.errors.find("mesh.obj: the input has changed since the job was planned"),
            std::string::npos)
      << outcome.errors;
  outcome = shard({"plan", "none.obj", "-o", "job", "--shards", "2"});
  EXPECT_TRUE(outcome.errors.starts_with("planetree: none.obj: ")) << outcome.errors;
}

}  // namespace
}  // namespace planetree::tools
