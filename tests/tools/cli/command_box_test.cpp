#include <gtest/gtest.h>

#include <string>

#include "planetree/planetree.h"
#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

const std::string kSolids = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/boxes.obj";
const std::string kHoled = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/sheet.obj";

/// Builds of a region, and what the subcommands report about them.
class CommandBox : public Command {
 protected:
  static Json build(const std::string& mesh, const std::string& box,
                    const std::string& side = "auto") {
    const Outcome result = run({"build", mesh, "-o", "part.ptree", "--force", "--page-size", "4K",
                                "--box=" + box, "--side", side, "--json", "--quiet"});
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output);
  }
  static Json inspect(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"inspect", "part.ptree", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output);
  }
};

TEST_F(CommandBox, RefusesMalformedBoxes) {
  for (const char* text : {"", "1", "0,0,0,1,1,1,1", "0,0,0,1,1,", "0,0,0,1,1,nan", "0,0,0,1,1,inf",
                           "0,0,0,1,1,1e999", "1,0,0,0,1,1", "0,0,1,1,1,0", "0 0 0 1 1 1",
                           "0,0,0,1,1,x", "0,0,0,1,1,1 ", " 0,0,0,1,1,1", "0,,0,1,1,1"}) {
    const Outcome result =
        run({"build", "mesh.obj", "-o", "new.ptree", std::string("--box=") + text});
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_FALSE(fs::exists("new.ptree")) << text;
  }
}

TEST_F(CommandBox, BuildsTheTrianglesThatTouchTheBox) {
  const Json built = build(kSolids, "-1,-1,-1,4,4,4");
  EXPECT_EQ(built["input_triangles"], 1296);
  EXPECT_LT(built["triangles"], 200);
  EXPECT_EQ(built["watertight"], true);
  const Json seen = inspect();
  EXPECT_EQ(seen["triangles"], built["triangles"]);
  EXPECT_EQ(seen["region"]["input_triangles"], 1296);
  EXPECT_EQ(seen["region"]["lower"], Json({-1.0, -1.0, -1.0}));
  EXPECT_EQ(seen["region"]["upper"], Json({4.0, 4.0, 4.0}));
  EXPECT_EQ(seen["box"]["upper"], Json({27.0, 16.0, 15.0}));
  const auto model = Model::open("part.ptree");
  ASSERT_TRUE(model);
  EXPECT_TRUE(model->info().has_region);
  EXPECT_EQ(model->info().input_triangles, 1296u);
  EXPECT_EQ(model->info().region_upper.y, 4);
}

TEST_F(CommandBox, ReportsNoRegionWithoutABox) {
  ASSERT_EQ(run({"build", kSolids, "-o", "part.ptree", "--quiet"}).status, 0);
  EXPECT_TRUE(inspect()["region"].is_null());
  EXPECT_EQ(run({"inspect", "part.ptree"}).output.find("region"), std::string::npos);
  const auto model = Model::open("part.ptree");
  ASSERT_TRUE(model);
  EXPECT_FALSE(model->info().has_region);
  EXPECT_EQ(model->info().input_triangles, model->info().triangles);
}

TEST_F(CommandBox, FilesOfRegionsVerify) {
  struct Part {
    std::string mesh;
    const char* box;
  };
  for (const auto& [mesh, box] :
       {Part{kSolids, "0,0,0,3,3,3"}, Part{kSolids, "1,1,-9,9,9,9"},
        Part{kSolids, "8,7,-50,8,7,50"}, Part{kSolids, "8,7,0,12,9,9"},
        Part{kSolids, "-99,-99,-99,99,99,99"}, Part{kHoled, "0.15,0.15,-9,0.25,1,9"},
        Part{kHoled, "-99,-99,-99,99,99,99"}, Part{"mesh.obj", "2,3,-1,5,5,1"},
        Part{"mesh.obj", "0,0,0,0,0,0"}}) {
    build(mesh, box);
    const Outcome result = run({"verify", "part.ptree", "--full"});
    EXPECT_EQ(result.status, 0) << mesh << ' ' << box << ": " << result.output << result.errors;
  }
}

TEST_F(CommandBox, ExplainsUnknownSides) {
  build(kSolids, "-1,-1,-1,4,4,4");
  EXPECT_EQ(inspect({"--why", "5,1,1"})["rule"], "region");
  EXPECT_EQ(inspect({"--why", "5,1,1"})["side"], "unknown");
  EXPECT_EQ(inspect({"--why", "1,1,1"})["side"], "inside");
  const Json held = build(kHoled, "-99,-99,-99,99,99,99", "solid");
  EXPECT_EQ(held["triangles"], held["input_triangles"]);
  EXPECT_EQ(inspect()["sign_rule"], "winding");
  build(kHoled, "0.15,0.15,-9,0.25,1,9", "solid");
  // Caps are those of the whole surface, so that sides within the walls are known.
  EXPECT_EQ(inspect()["sign_rule"], "winding");
  EXPECT_EQ(inspect({"--why", "0.2,0.2,3"})["side"], "outside");
  EXPECT_EQ(inspect({"--why", "0.3,0.2,3"})["rule"], "region");
}

TEST_F(CommandBox, HelpNamesTheFlag) {
  EXPECT_NE(run({"build", "--help"}).output.find("--box"), std::string::npos);
}

}  // namespace
}  // namespace planetree::tools
