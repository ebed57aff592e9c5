// Traces of `planetree query`.

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tests/tools/trace_file/sample_trace.h"

namespace planetree::tools {
namespace {

using Event = PageAccess::Event;

class QueryTrace : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    std::string points;
    for (int i = 0; i < 500; ++i)
      points += std::to_string(i % 10) + ',' + std::to_string(i / 10 % 10) + ",0." +
                std::to_string(i / 100) + '\n';
    write("points.csv", points);
  }
  Outcome query(const std::vector<std::string>& more) {
    std::vector<std::string> words = {"query",       "tree.ptree", "points.csv", "-o",
                                      "answers.csv", "--force",    "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
};

TEST_F(QueryTrace, HoldsTheLookupsOfABatch) {
  for (const bool contains : {false, true}) {
    std::vector<std::string> options = {"--trace", "q.trace", "--policy", "2q", "--threads", "2"};
    if (contains) options.push_back("--contains");
    const Outcome outcome = query(options);
    ASSERT_EQ(outcome.status, kDone) << outcome.errors;
    const Json report = Json::parse(lines_of(outcome.errors).back());
    const TraceContents trace = read_trace("q.trace");
    ASSERT_EQ(trace.error, "");
    EXPECT_EQ(trace.header.policy, EvictionPolicy::kTwoQ);
    EXPECT_EQ(trace.header.memory_bytes, report["budget_bytes"]);
    EXPECT_EQ(trace.header.rate_hz, 0u);
    EXPECT_EQ(trace.totals.lost, 0u);
    std::uint64_t read = 0, lookups = 0;
    for (const PageAccess& access : trace.records) {
      read += access.event == Event::kInstalled;
      if (access.query_kind == PageAccess::Query::kOpen) continue;
      EXPECT_EQ(access.query_kind,
                contains ? PageAccess::Query::kContains : PageAccess::Query::kClosestPoint);
      EXPECT_TRUE(access.in_batch);
      EXPECT_TRUE(access.waits);
      EXPECT_LT(access.query, 500u);
      lookups += access.event <= Event::kFetched;
    }
    EXPECT_EQ(read, report["pages_read"]);
    EXPECT_GT(lookups, contains ? 0u : 100u);
  }
}

TEST_F(QueryTrace, DoesNotChangeAnswers) {
  ASSERT_EQ(query({}).status, kDone);
  const std::string answers = text_of("answers.csv");
  ASSERT_EQ(query({"--trace", "q.trace"}).status, kDone);
  EXPECT_EQ(text_of("answers.csv"), answers);
}

TEST_F(QueryTrace, ReplacesNoFileUnlessAllowed) {
  write("q.trace", "mine");
  const Outcome refused = run({"query", "tree.ptree", "points.csv", "--trace", "q.trace"});
  EXPECT_EQ(refused.status, kCommandLineAtFault);
  EXPECT_EQ(refused.output, "");
  EXPECT_EQ(text_of("q.trace"), "mine");
  EXPECT_EQ(query({"--trace", "-"}).status, kCommandLineAtFault);
}

TEST_F(QueryTrace, IsNotWrittenIfAPointCannotBeRead) {
  write("points.csv", "1,2,3\n1,x,3\n");
  EXPECT_EQ(query({"--trace", "q.trace"}).status, kDataAtFault);
  EXPECT_FALSE(fs::exists("q.trace"));
}

}  // namespace
}  // namespace planetree::tools
