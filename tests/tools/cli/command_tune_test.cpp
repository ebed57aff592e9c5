#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

class CommandTune : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    record("tree.ptree", "a.trace", "1");
  }
  static void record(const std::string& model, const std::string& trace, const std::string& seed) {
    const Outcome recorded = run({"touch", model, "--deterministic", "--seconds", "1", "--path",
                                  "scratch", "--seed", seed, "--trace", trace});
    ASSERT_EQ(recorded.status, 0) << recorded.errors;
  }
  static Json tuned(std::vector<std::string> options) {
    options.insert(options.begin(), {"tune", "--json"});
    const Outcome result = run(options);
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output);
  }
};

TEST_F(CommandTune, ReportsCurvesPrefetchAndWhatIsFelt) {
  const Json report = tuned({"a.trace"});
  EXPECT_GT(report["references"], 0);
  EXPECT_GE(report["queries"], 900);
  EXPECT_EQ(report["lost_records"], 0);
  ASSERT_EQ(report["curves"].size(), 5u);
  for (const Json& curve : report["curves"])
    for (std::size_t i = 0; i < curve["points"].size(); ++i)
      EXPECT_GE(curve["points"][i]["misses"], report["optimum"][i]["misses"]) << curve["policy"];
  EXPECT_GT(report["felt"].size(), 1u);
  for (const Json& point : report["felt"]) EXPECT_EQ(point["ticks"], 1000);
  EXPECT_TRUE(report["recommended"].is_null());
}

TEST_F(CommandTune, AddsTracesUp) {
  record("tree.ptree", "b.trace", "2");
  const Json one = tuned({"a.trace"}), other = tuned({"b.trace"});
  const Json both = tuned({"a.trace", "b.trace"});
  EXPECT_EQ(both["traces"], (Json{"a.trace", "b.trace"}));
  for (const char* count : {"references", "queries", "compulsory_misses", "recorded_misses"})
    EXPECT_EQ(both[count], one[count].get<int>() + other[count].get<int>()) << count;
  EXPECT_EQ(both["felt"][0]["ticks"], 2000);
}

TEST_F(CommandTune, TellsPeopleWhatToSet) {
  const Outcome result = run({"tune", "a.trace", "--recommend", "degraded < 50%", "--pages",
                              "4K,16K", "--latency", "100us", "--quiet"});
  EXPECT_EQ(result.status, 0) << result.errors;
  for (const char* part : {"footprint", "knee of clock", "prefetch, as recorded", "after 100 us",
                           "page size", "For degraded < 50.0 %", "OpenOptions", "--policy clock"})
    EXPECT_NE(result.output.find(part), std::string::npos) << part << "\n" << result.output;
}

TEST_F(CommandTune, ExportsLookups) {
  const Outcome csv = run({"tune", "a.trace", "--export", "csv"});
  EXPECT_EQ(csv.status, 0) << csv.errors;
  EXPECT_TRUE(csv.output.starts_with("time_s,page,bytes\n0.")) << csv.output.substr(0, 60);
  const auto lines = std::count(csv.output.begin(), csv.output.end(), '\n');
  EXPECT_GT(lines, 1);
  EXPECT_LE(lines - 1, tuned({"a.trace"})["references"].get<int>());
  EXPECT_EQ(csv.output.find(",0,"), std::string::npos) << "the root is pinned";
  const Outcome binary = run({"tune", "a.trace", "--export", "oracleGeneral"});
  EXPECT_EQ(binary.output.size(), 24u * static_cast<std::size_t>(lines - 1));
}

TEST_F(CommandTune, WritesAPage) {
  EXPECT_EQ(run({"tune", "a.trace", "--quiet", "--html", "out.html"}).status, 0);
  const std::string html = text_of("out.html");
  EXPECT_NE(html.find("planetree tune a.trace --html out.html --force"), std::string::npos);
  EXPECT_EQ(run({"tune", "a.trace", "--quiet", "--html", "out.html"}).status, 2) << "it exists";
  EXPECT_EQ(run({"tune", "a.trace", "--quiet", "--html", "out.html", "--force"}).status, 0);
  EXPECT_EQ(run({"tune", "a.trace", "--html", "a.trace", "--force"}).status, 2);
}

TEST_F(CommandTune, NeedsNoModelForCurves) {
  fs::rename("tree.ptree", "moved.ptree");
  const Json report = tuned({"a.trace"});
  EXPECT_EQ(report["felt"].size(), 0u);
  const Outcome asked = run({"tune", "a.trace", "--recommend", "degraded<1%"});
  EXPECT_EQ(asked.status, 2);
  EXPECT_NE(asked.errors.find("--model"), std::string::npos) << asked.errors;
  EXPECT_EQ(tuned({"a.trace", "--model", "moved.ptree"})["felt"][0]["ticks"], 1000);
}

TEST_F(CommandTune, RefusesWhatDoesNotFit) {
  EXPECT_EQ(run({"tune"}).status, 2);
  EXPECT_EQ(run({"tune", "none.trace"}).status, 2);
  EXPECT_EQ(run({"tune", "mesh.obj"}).status, 1) << "no trace";
  EXPECT_EQ(run({"tune", "a.trace", "--recommend", "fast"}).status, 2);
  EXPECT_EQ(run({"tune", "a.trace", "--pages", "5K"}).status, 2);
  EXPECT_EQ(run({"tune", "a.trace", "--export", "csv", "--html", "x.html"}).status, 2);
  write_mesh("other.obj", kSide / 2);
  build_sample("other.obj", "other.ptree");
  record("other.ptree", "other.trace", "1");
  const Outcome mixed = run({"tune", "a.trace", "other.trace"});
  EXPECT_EQ(mixed.status, 1);
  EXPECT_NE(mixed.errors.find("another model"), std::string::npos) << mixed.errors;
  EXPECT_EQ(run({"tune", "a.trace", "--model", "other.ptree"}).status, 1);
  const std::string bytes = text_of("a.trace");
  write("cut.trace", bytes.substr(0, bytes.size() / 2));
  EXPECT_EQ(run({"tune", "cut.trace"}).status, 1);
}

}  // namespace
}  // namespace planetree::tools
