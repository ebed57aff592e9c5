#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tests/tools/values/ply_text.h"
#include "tools/values/colour_scale.h"

namespace planetree::tools {
namespace {

constexpr const char* kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

class CommandCompare : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    write("cube.obj", kCube);
    ASSERT_EQ(run({"build", "cube.obj", "-o", "cube.ptree", "--quiet"}).status, 0);
  }
  static Json compared(std::vector<std::string> options, const std::string& input = "") {
    options.insert(options.begin(), {"compare", "cube.ptree"});
    options.insert(options.end(), {"--json", "--quiet"});
    const Outcome result = run(options, input);
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output);
  }
};

// Points above the middle of the cube's top, 0.3 below to 0.2 above it.
std::string points_about_the_top() {
  std::string text = "x,y,z\n";
  for (int i = 0; i <= 100; ++i) text += fmt::format("0.5,0.5,{}\n", 0.7 + 0.005 * i);
  return text;
}

TEST_F(CommandCompare, MeasuresSignedDeviations) {
  const Json report = compared({"-", "--tolerance", "0.25"}, points_about_the_top());
  EXPECT_EQ(report["points"], 101);
  EXPECT_EQ(report["inside"], 60);
  EXPECT_EQ(report["on_surface"], 1);
  EXPECT_EQ(report["outside"], 40);
  EXPECT_EQ(report["side_unknown"], 0);
  EXPECT_NEAR(report["min"]["deviation"], -0.3, 1e-12);
  EXPECT_NEAR(report["max"]["deviation"], 0.2, 1e-12);
  EXPECT_EQ(report["max"]["point"], (Json{0.5, 0.5, 1.2}));
  EXPECT_EQ(report["max"]["nearest"], (Json{0.5, 0.5, 1}));
  EXPECT_NEAR(report["mean"], -0.05, 1e-12);
  double squares = 0;
  for (int i = 0; i <= 100; ++i) squares += std::pow(0.005 * i - 0.3, 2);
  EXPECT_NEAR(report["rms"], std::sqrt(squares / 101), 1e-12);
  EXPECT_NEAR(report["percentiles"]["p50"], -0.05, 1e-4);
  EXPECT_NEAR(report["percentiles"]["p90"], 0.15, 1e-4);
  EXPECT_NEAR(report["absolute_percentiles"]["p99"], 0.295, 2e-4);
  EXPECT_EQ(report["tolerance"]["beyond"], 10);
  EXPECT_NEAR(report["tolerance"]["share_beyond"], 10.0 / 101, 1e-12);
  EXPECT_LE(report["hausdorff"]["lower"], 0.3);
  EXPECT_GE(report["hausdorff"]["upper"], 0.3);
  EXPECT_NEAR(report["hausdorff"]["upper"], report["hausdorff"]["lower"], 1e-12);
  EXPECT_EQ(report["hausdorff"]["point"], (Json{0.5, 0.5, 0.7}));
}

TEST_F(CommandCompare, LeavesSidesOutIfTold) {
  const Json report = compared({"-", "--unsigned"}, points_about_the_top());
  EXPECT_FALSE(report.contains("inside"));
  EXPECT_NEAR(report["min"]["deviation"], 0, 1e-12);
  EXPECT_NEAR(report["max"]["deviation"], 0.3, 1e-12);
  EXPECT_EQ(report["histogram"]["lower"], 0);
}

TEST_F(CommandCompare, DoesNotDependOnThreadsOrMemory) {
  std::string text;
  for (int i = 0; i < 2000; ++i)
    text += fmt::format("{},{},{}\n", i % 19 * 0.09, i % 23 * 0.08, i % 7 * 0.3);
  Json first = compared({"-", "--threads", "1"}, text);
  Json second = compared({"-", "--threads", "3", "--memory", "128M"}, text);
  for (const char* key :
       {"seconds", "points_per_second", "pages_read", "budget_bytes", "peak_resident_bytes"}) {
    first.erase(key);
    second.erase(key);
  }
  EXPECT_EQ(first, second);
}

TEST_F(CommandCompare, MapsDeviationsToColours) {
  compared({"-", "-o", "out.ply", "--colour-range", "0.25"}, points_about_the_top() + "nan,0,0\n");
  const PlyText ply(text_of("out.ply"));
  ASSERT_TRUE(ply.is_whole) << ply.header;
  ASSERT_EQ(ply.points.size(), 102u);
  EXPECT_EQ(ply.points[100].place.z, 1.2);
  EXPECT_FLOAT_EQ(ply.points[0].value, -0.3F);
  EXPECT_FLOAT_EQ(ply.points[100].value, 0.2F);
  const ColourScale scale = ColourScale::diverging(0.25);
  EXPECT_EQ(ply.points[0].colour, scale.colour(-0.25));
  EXPECT_EQ(ply.points[100].colour, scale.colour(0.2));
  EXPECT_EQ(ply.points[101].colour, ColourScale::kNoValue);
  const Json again = compared({"out.ply"});
  EXPECT_EQ(again["points"], 102) << "the command reads what it writes";
}

// A cube around the model, of edge 2 and with the same middle.
TEST_F(CommandCompare, MeasuresAMesh) {
  std::string cube = kCube;
  for (const auto& [from, to] :
       {std::pair{" 0", " -0.5"}, std::pair{" 1 ", " 1.5 "}, std::pair{" 1\n", " 1.5\n"}})
    for (std::size_t at = cube.find(from); at < cube.find("f "); at = cube.find(from, at + 3))
      cube.replace(at, std::string(from).size(), to);
  write("around.obj", cube);
  const Json report = compared({"around.obj", "-o", "out.ply", "--spacing", "0.1"});
  EXPECT_EQ(report["mesh"]["triangles"], 12);
  EXPECT_EQ(report["inside"], 0);
  EXPECT_EQ(report["min"]["deviation"], 0.5);
  EXPECT_NEAR(report["max"]["deviation"], std::sqrt(0.75), 1e-12) << "a corner";
  // Over the middle of a side the deviation is 0.5: over the cube's side of a quarter of the area.
  EXPECT_NEAR(report["percentiles"]["p50"], 0.543, 0.01);
  EXPECT_LE(report["hausdorff"]["lower"], std::sqrt(0.75));
  EXPECT_GE(report["hausdorff"]["upper"], std::sqrt(0.75));
  EXPECT_TRUE(report["hausdorff"]["is_within_error"]);
  const PlyText ply(text_of("out.ply"));
  ASSERT_TRUE(ply.is_whole) << ply.header;
  EXPECT_EQ(ply.points.size(), report["points"]);
  EXPECT_GT(ply.triangles.size(), 12u);
  for (const auto& triangle : ply.triangles)
    for (const std::uint32_t corner : triangle) ASSERT_LT(corner, ply.points.size());
  EXPECT_EQ(compared({"out.ply", "--spacing", "inf"})["mesh"]["triangles"], ply.triangles.size());
  EXPECT_TRUE(compared({"out.ply", "--read-as", "points"})["mesh"].is_null());
}

TEST_F(CommandCompare, FindsAMeshEqualToItself) {
  const Json report = compared({"cube.obj", "--spacing", "0.1"});
  EXPECT_EQ(report["on_surface"], report["points"]);
  EXPECT_EQ(report["max"]["deviation"], 0);
  EXPECT_EQ(report["hausdorff"]["lower"], 0);
  EXPECT_LT(report["hausdorff"]["upper"], 1e-12);
}

TEST_F(CommandCompare, CountsWhatIsBeyondTheMaximumDistance) {
  const Json report =
      compared({"-", "--max-distance", "0.102", "--tolerance", "0.101"}, points_about_the_top());
  EXPECT_EQ(report["beyond_max_distance"], 60);
  EXPECT_EQ(report["measured"], 41);
  EXPECT_EQ(report["tolerance"]["beyond"], 60);
  EXPECT_EQ(report["hausdorff"]["lower"], 0.102);
  EXPECT_TRUE(report["hausdorff"]["upper"].is_null());
  EXPECT_TRUE(report["hausdorff"]["nearest"].is_null());
}

TEST_F(CommandCompare, ReportsInWordsAndAsAPage) {
  const Outcome result =
      run({"compare", "cube.ptree", "-", "--quiet", "--html", "out.html", "--tolerance", "0.25"},
          points_about_the_top());
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_NE(result.output.find("101 points: 60 inside, 40 outside, 1 on the surface"),
            std::string::npos)
      << result.output;
  EXPECT_NE(result.output.find("beyond 0.25: 10 points, 9.9 %"), std::string::npos);
  EXPECT_NE(result.output.find("one-sided Hausdorff"), std::string::npos);
  const std::string html = text_of("out.html");
  EXPECT_EQ(html.find("<!DOCTYPE html>"), 0u);
  EXPECT_NE(html.find("id=\"deviations\""), std::string::npos);
  EXPECT_NE(html.find("planetree compare cube.ptree - --tolerance 0.25 --html out.html --force"),
            std::string::npos);
}

TEST_F(CommandCompare, RefusesWhatItCannotCompare) {
  EXPECT_EQ(run({"compare", "cube.ptree", "-"}, "").status, 1);
  EXPECT_EQ(run({"compare", "cube.ptree", "-"}, "x,y,z\n1,2\n").status, 1);
  EXPECT_EQ(run({"compare", "cube.obj", "-"}, "0,0,0\n").status, 1);
  EXPECT_EQ(run({"compare", "none.ptree", "-"}, "0,0,0\n").status, 2);
  EXPECT_EQ(run({"compare", "cube.ptree", "none.csv"}).status, 2);
  EXPECT_EQ(run({"compare", "cube.ptree", "-", "-o", "-"}, "0,0,0\n").status, 2);
  EXPECT_EQ(run({"compare", "cube.ptree", "-", "--read-as", "mesh"}, "0,0,0\n").status, 2);
  EXPECT_EQ(run({"compare", "cube.ptree", "cube.obj", "--spacing", "0"}).status, 2);
  write("bad.off", "OFF\n3 1 0\n0 0 0\n");
  EXPECT_EQ(run({"compare", "cube.ptree", "bad.off"}).status, 1);
  EXPECT_EQ(run({"compare", "cube.ptree", "-", "--tolerance", "2", "--max-distance", "1"}).status,
            2);
  EXPECT_EQ(run({"compare", "cube.ptree", "-", "-o", "cube.ptree", "--force"}).status, 2);
  EXPECT_EQ(run({"compare", "cube.ptree", "-", "--memory", "64K"}, "0,0,0\n").status, 3);
}

TEST_F(CommandCompare, LeavesNoFileBehindIfItFails) {
  EXPECT_EQ(run({"compare", "cube.ptree", "-", "-o", "out.ply", "--html", "out.html"},
                "x,y,z\n0,0,0\n1,2\n")
                .status,
            1);
  EXPECT_FALSE(fs::exists("out.ply"));
  EXPECT_FALSE(fs::exists("out.html"));
  write("out.ply", "mine");
  EXPECT_EQ(run({"compare", "cube.ptree", "-", "-o", "out.ply"}, "0,0,0\n").status, 2);
  EXPECT_EQ(text_of("out.ply"), "mine");
}

}  // namespace
}  // namespace planetree::tools
