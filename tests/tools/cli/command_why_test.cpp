#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "planetree/planetree.h"
#include "tests/tools/cli/command_fixture.h"
#include "tools/report/explanation.h"

namespace planetree::tools {
namespace {

const std::string kBoxes = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/boxes.ptree";
const std::string kSheet = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/sheet.ptree";

Json why(const std::string& file, const std::string& point) {
  const Outcome result = run({"inspect", file, "--why", point, "--json"});
  EXPECT_EQ(result.status, 0) << result.errors;
  return Json::parse(result.output);
}

TEST(Why, NamesTheRuleThatDecidedTheSide) {
  struct Case {
    const char* point;
    const char* side;
    const char* rule;
  };
  // The boxes are (0 0 0)-(10 10 10), (7 6 5)-(17 16 15), (11 -15 -2)-(27 -1 14).
  for (const auto& [point, side, rule] :
       {Case{"-1,5,5", "outside", "outside_box"}, Case{"1,13,1", "outside", "colour"},
        Case{"13,-5,6", "inside", "colour"}, Case{"10,3,4.5", "on_surface", "planes"}}) {
    const Json answer = why(kBoxes, point);
    EXPECT_EQ(answer["side"], side) << point;
    EXPECT_EQ(answer["rule"], rule) << point;
  }
}

TEST(Why, AgreesWithTheAnswersOfAProbe) {
  const auto model = Model::open(kBoxes);
  ASSERT_TRUE(model);
  auto probe = Probe::create(*model);
  ASSERT_TRUE(probe);
  unsigned corners = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 query{0.13 * i, -15 + 0.155 * i, -2 + 0.083 * i};
    const auto explanation = explain(kBoxes, query);
    ASSERT_TRUE(explanation);
    EXPECT_EQ(explanation->answer.side, probe->contains(query).side);
    EXPECT_EQ(explanation->answer.distance, probe->closest_point(query).distance);
    const query::SideReason& reason = explanation->reason;
    if (reason.rule != query::SideReason::Rule::kCorner) continue;
    ++corners;
    EXPECT_EQ(reason.known + reason.crossings, explanation->side_result.winding);
    EXPECT_TRUE(explanation->cell_lower.x <= query.x && query.x <= explanation->cell_upper.x);
    EXPECT_GT(explanation->side_work.nodes, 0u);
  }
  EXPECT_GT(corners, 10u);
}

TEST(Why, NamesTheNearestFeatureOfASheet) {
  const Json answer = why(kSheet, "0.5,0.5,9");
  EXPECT_EQ(answer["rule"], "nearest_feature");
  EXPECT_FALSE(answer.contains("cell"));
}

TEST_F(Command, WhyReportsTheWindingNumberOfAnOpenSolid) {
  ASSERT_EQ(run({"build", "mesh.obj", "-o", "solid.ptree", "--side", "solid", "--quiet"}).status,
            0);
  const Json answer = why("solid.ptree", "0.5,0.5,0.1");
  EXPECT_EQ(answer["rule"], "winding_number");
  EXPECT_LT(answer["winding_number"]["error"], 0.5);
  EXPECT_TRUE(answer.contains("cell"));
}

TEST(Why, PrintsTheRuleAsText) {
  const Outcome result = run({"inspect", kBoxes, "--why", "13,-5,6"});
  EXPECT_EQ(result.status, 0);
  EXPECT_NE(result.output.find("inside: cell"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("of the mask is inverted"), std::string::npos) << result.output;
}

TEST(Why, RefusesMalformedPoints) {
  for (const char* text : {"1,2", "1,2,3,4", "1;2;3", "nan,0,0", "1,2,inf", "", "1,2,x"}) {
    EXPECT_FALSE(parse_point(text)) << text;
    EXPECT_EQ(run({"inspect", kBoxes, "--why", text}).status, 2) << text;
  }
  EXPECT_EQ(run({"inspect", "nowhere.ptree", "--why", "1,2,3"}).status, 2);
}

TEST(Why, InspectCountsColoursByLevel) {
  const Json report = Json::parse(run({"inspect", kBoxes, "--json", "--levels"}).output);
  Json sum = {{"white", 0}, {"black", 0}, {"grey", 0}, {"with_corners", 0}, {"special", 0}};
  for (const Json& level : report["mask_by_level"])
    for (auto& [name, count] : sum.items()) count = count.get<int>() + level[name].get<int>();
  EXPECT_EQ(sum, report["mask"]);
  EXPECT_EQ(report["special_configurations"], sum["special"]);
  EXPECT_GT(sum["special"], 0);
  EXPECT_GT(sum["black"], 0);
  // Every octant of a divided cell has a colour; the root is no octant.
  const int divided =
      sum["grey"].get<int>() - sum["with_corners"].get<int>() - sum["special"].get<int>();
  EXPECT_EQ(sum["white"].get<int>() + sum["black"].get<int>() + sum["grey"].get<int>(),
            8 * divided + 1);
  const std::uint64_t bytes = report["bytes"]["headers"].get<std::uint64_t>() +
                              report["bytes"]["directory"].get<std::uint64_t>() +
                              report["bytes"]["distance_pages"].get<std::uint64_t>() +
                              report["bytes"]["field_pages"].get<std::uint64_t>() +
                              report["bytes"]["mask_pages"].get<std::uint64_t>();
  EXPECT_EQ(bytes, std::filesystem::file_size(kBoxes));
}

}  // namespace
}  // namespace planetree::tools
