#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tools/trade/median_edge.h"

namespace planetree::tools {
namespace {

class CommandTrade : public Command {
 protected:
  static Json measured(std::vector<std::string> options, const std::string& input = "") {
    options.insert(options.begin(), {"trade", "tree.ptree", "--json", "--count", "50"});
    const Outcome result = run(options, input);
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output);
  }
};

TEST_F(CommandTrade, MeasuresEachSettingOnEachWorkload) {
  const Json report = measured({});
  EXPECT_EQ(report["triangles"], kTriangles);
  EXPECT_GT(report["diagonal"], 0);
  std::set<std::string> workloads;
  int exact = 0, tolerant = 0, limited = 0, never = 0;
  for (const Json& row : report["rows"]) {
    workloads.insert(row["workload"]);
    EXPECT_EQ(row["broken"], 0) << row;
    EXPECT_EQ(row["side_wrong"], 0) << row;
    EXPECT_GT(row["queries_per_second"], 0) << row;
    EXPECT_LE(row["promised_p50"], row["promised_p99"]) << row;
    const Json& options = row["options"];
    if (options["wait"] == "never") {
      ++never;
    } else if (options["max_error"] > 0) {
      ++tolerant;
      EXPECT_LE(row["promised_max"], options["max_error"]) << row;
      EXPECT_LE(row["true_max"], options["max_error"]) << row;
    } else if (!options["max_work"].is_null()) {
      ++limited;
    } else {
      ++exact;
      EXPECT_EQ(row["true_max"], 0);
      EXPECT_EQ(row["exact_share"], 1);
      EXPECT_EQ(row["ratio_to_exact"], 1);
      EXPECT_GT(row["pages_per_query"], 0);
    }
  }
  EXPECT_EQ(workloads, (std::set<std::string>{"uniform", "near", "path"}));
  EXPECT_EQ(exact, 3);
  EXPECT_EQ(tolerant, 3 * 7);
  EXPECT_EQ(limited, 3 * 7);
  EXPECT_GT(never, 0);
}

TEST_F(CommandTrade, RecommendsOptionsThatKeepTheirError) {
  const Json report = measured({});
  ASSERT_EQ(report["recommended"].size(), 4u);
  for (const Json& recommended : report["recommended"])
    EXPECT_LE(recommended["options"]["max_error"], recommended["max_error"]);
  EXPECT_NEAR(report["recommended"][0]["max_error"], 1e-4 * report["diagonal"].get<double>(),
              1e-12);
}

// The distances alone, so that the field answers near the surface too.
TEST_F(CommandTrade, MeasuresTheGivenParts) {
  const Json report = measured({"--parts", "distance"});
  for (const Json& row : report["rows"]) {
    EXPECT_EQ(row["parts"], Json({"distance"}));
    EXPECT_EQ(row["broken"], 0) << row;
  }
  const Outcome words =
      run({"trade", "tree.ptree", "--count", "20", "--quiet", "--parts", "distance"});
  EXPECT_NE(words.output.find(", parts distance"), std::string::npos) << words.output;
  EXPECT_NE(words.output.find("POINTS --parts distance"), std::string::npos) << words.output;
  EXPECT_EQ(run({"trade", "tree.ptree", "--parts", "side"}).status, 2);
  EXPECT_EQ(run({"trade", "tree.ptree", "--parts", "colour"}).status, 2);
}

// The recommended options, given to the query command, keep the error at other points.
TEST_F(CommandTrade, RecommendsOptionsThatKeepTheirErrorElsewhere) {
  const Json report = measured({"--parts", "distance"});
  std::string points = "x,y,z\n";
  for (int i = 0; i < 200; ++i)
    points += fmt::format("{},{},{}\n", i * 0.017 - 1.5, i % 23 * 0.11 - 1, i % 7 * 0.3 - 1);
  int answered = 0;
  for (const Json& recommended : report["recommended"]) {
    const double error = recommended["options"]["max_error"];
    const Outcome answers = run({"query", "tree.ptree", "-", "--parts", "distance", "--max-error",
                                 fmt::format("{}", error), "--format", "jsonl", "--quiet"},
                                points);
    ASSERT_EQ(answers.status, 0) << answers.errors;
    std::istringstream lines(answers.output);
    for (std::string line; std::getline(lines, line);) {
      const Json answer = Json::parse(line);
      EXPECT_LE(answer["upper"].get<double>() - answer["lower"].get<double>(),
                recommended["max_error"].get<double>());
      answered += answer["status"] == "within_error" || answer["status"] == "exact";
    }
  }
  EXPECT_EQ(answered, 4 * 200);
}

TEST_F(CommandTrade, AsksAtGivenPoints) {
  const Json report = measured({"--points", "-"}, "0,0,1\n1,1,1\n3,2,1\n");
  for (const Json& row : report["rows"]) {
    EXPECT_EQ(row["workload"], "points");
    EXPECT_EQ(row["points"], 3);
  }
}

TEST_F(CommandTrade, EndsWithTheCommandToUse) {
  const Outcome result = run({"trade", "tree.ptree", "--count", "20", "--quiet"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.errors, "");
  EXPECT_NE(result.output.find("uniform, 20 points"), std::string::npos);
  EXPECT_NE(result.output.find("\nplanetree query tree.ptree POINTS"), std::string::npos);
}

TEST_F(CommandTrade, RefusesWhatItCannotMeasure) {
  EXPECT_EQ(run({"trade", "tree.ptree", "--count", "0"}).status, 2);
  EXPECT_EQ(run({"trade", "none.ptree"}).status, 2);
  EXPECT_EQ(run({"trade", "mesh.obj"}).status, 1);
  EXPECT_EQ(run({"trade", "tree.ptree", "--points", "-"}, "").status, 1);
  write("one.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n");
  ASSERT_EQ(run({"build", "one.obj", "-o", "one.ptree", "--quiet"}).status, 0);
  const Outcome result = run({"trade", "one.ptree"});
  EXPECT_EQ(result.status, 1);
  EXPECT_NE(result.errors.find("nothing to trade"), std::string::npos);
}

TEST_F(CommandTrade, WritesAPage) {
  const Outcome result =
      run({"trade", "tree.ptree", "--count", "20", "--quiet", "--html", "out.html"});
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_NE(result.output.find("uniform, 20 points"), std::string::npos) << "the report too";
  const std::string html = text_of("out.html");
  EXPECT_EQ(html.find("<!DOCTYPE html>"), 0u);
  EXPECT_TRUE(html.ends_with("</html>\n"));
  EXPECT_NE(html.find("planetree trade tree.ptree --count 20 --html out.html --force"),
            std::string::npos);
}

TEST_F(CommandTrade, ReplacesAPageOnlyIfTold) {
  write("out.html", "mine");
  const std::vector<std::string> options = {"trade",   "tree.ptree", "--count", "2",
                                            "--quiet", "--html",     "out.html"};
  const Outcome refused = run(options);
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.output, "") << "nothing is measured before";
  EXPECT_NE(refused.errors.find("--force"), std::string::npos);
  EXPECT_EQ(text_of("out.html"), "mine");
  std::vector<std::string> forced = options;
  forced.emplace_back("--force");
  EXPECT_EQ(run(forced).status, 0);
  EXPECT_NE(text_of("out.html"), "mine");
  EXPECT_EQ(run({"trade", "tree.ptree", "--force"}).status, 2) << "there is nothing to replace";
}

TEST_F(CommandTrade, LeavesNoPageBehindIfItFails) {
  EXPECT_EQ(run({"trade", "mesh.obj", "--html", "out.html"}).status, 1);
  EXPECT_EQ(run({"trade", "tree.ptree", "--html", "none/out.html"}).status, 2);
  EXPECT_EQ(run({"trade", "tree.ptree", "--count", "2", "--quiet", "--html", "/dev/full"}).status,
            3);
  EXPECT_FALSE(fs::exists("out.html"));
  for (const auto& entry : fs::directory_iterator("."))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".planetree")) << entry;
}

TEST_F(CommandTrade, DoesNotReplaceItsInputs) {
  write("points.csv", "0,0,1\n");
  const std::string model = text_of("tree.ptree");
  const Outcome over_model = run({"trade", "tree.ptree", "--html", "tree.ptree", "--force"});
  EXPECT_EQ(over_model.status, 2);
  EXPECT_NE(over_model.errors.find("an input itself"), std::string::npos);
  EXPECT_EQ(
      run({"trade", "tree.ptree", "--points", "points.csv", "--html", "points.csv", "--force"})
          .status,
      2);
  EXPECT_EQ(text_of("tree.ptree"), model);
  EXPECT_EQ(text_of("points.csv"), "0,0,1\n");
}

TEST_F(CommandTrade, AsksAtThePositionsOfASession) {
  ASSERT_EQ(
      run({"touch", "tree.ptree", "--seconds", "1", "--rate", "50", "--ticks", "ticks.csv"}).status,
      0);
  const Json report = measured({"--points", "ticks.csv"});
  EXPECT_EQ(report["rows"][0]["points"], 50);
}

// Two triangles with legs of 1 and a shared hypotenuse.
TEST_F(CommandTrade, MedianEdgeIsThatOfTheTriangles) {
  write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  ASSERT_EQ(run({"build", "square.obj", "-o", "square.ptree", "--quiet"}).status, 0);
  const auto edge = median_edge("square.ptree");
  ASSERT_TRUE(edge);
  EXPECT_EQ(*edge, 1);
  EXPECT_FALSE(median_edge("square.obj"));
}

}  // namespace
}  // namespace planetree::tools
