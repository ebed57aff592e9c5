#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

/// Sides and normals of a square in the plane z = 0 and of a cube without its top.
class CommandSide : public Command {
 protected:
  static Json built(const std::string& mesh, const std::string& side) {
    const Outcome result =
        run({"build", mesh, "-o", "side.ptree", "--force", "--side", side, "--json", "--quiet"});
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output);
  }
  static Json asked(const std::string& point, std::vector<std::string> options) {
    options.insert(options.begin(), {"query", "side.ptree", "--format", "jsonl"});
    const Outcome result = run(options, point + "\n");
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output);
  }
  static std::string side(const std::string& point, std::vector<std::string> options = {}) {
    return asked(point, std::move(options))["side"];
  }
  static double up(const std::string& point, std::vector<std::string> options = {}) {
    return asked(point, std::move(options))["nz"];
  }

  static constexpr const char* kSquare = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3\nf 1 3 4\n";
};

TEST_F(CommandSide, OfASheetIsThatOfTheNearestFace) {
  write("square.obj", kSquare);
  const Json report = built("square.obj", "auto");
  EXPECT_EQ(report["side_rule"], "surface");
  EXPECT_EQ(report["openness"], 1);
  for (const char* height : {"1e-9", "0.001", "1", "1000"}) {
    EXPECT_EQ(side(std::string("1.5,1,") + height), "outside");
    EXPECT_EQ(side(std::string("1.5,1,-") + height), "inside");
    EXPECT_EQ(side(std::string("1.5,1,-") + height, {"--contains"}), "inside");
    EXPECT_EQ(up(std::string("1.5,1,-") + height), 1);
    EXPECT_EQ(up(std::string("1.5,1,-") + height, {"--normals", "toward-query"}), -1);
    EXPECT_EQ(up(std::string("1.5,1,") + height, {"--normals", "toward-query"}), 1);
  }
  EXPECT_EQ(side("1.5,1,0"), "on_surface");
  EXPECT_EQ(side("5,1,0"), "outside");
  EXPECT_EQ(side("1.5,1,-1000", {"--side", "solid"}), "outside");
}

TEST_F(CommandSide, FollowsTheBuildersOption) {
  write("square.obj", kSquare);
  EXPECT_EQ(built("square.obj", "solid")["side_rule"], "solid");
  EXPECT_EQ(side("1.5,1,-1000"), "outside");
  EXPECT_EQ(side("1.5,1,-1000", {"--side", "surface"}), "inside");
  EXPECT_NE(run({"inspect", "side.ptree"}).output.find("as the build was told"), std::string::npos);
  write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_EQ(built("solid.obj", "auto")["side_rule"], "solid");
  EXPECT_EQ(built("solid.obj", "surface")["side_rule"], "surface");
  EXPECT_EQ(side("0.1,0.1,0.1"), "inside");
  EXPECT_EQ(side("0.1,0.1,-0.1"), "outside");
  EXPECT_EQ(run({"verify", "side.ptree", "--full"}).status, 0);
}

TEST_F(CommandSide, BelongsToTheNearestTriangleWhateverTheErrorAllowed) {
  const auto status = [](std::vector<std::string> options) {
    options.insert(options.begin(), {"query", "tree.ptree", "--max-error", "100"});
    const std::string row = run(options, "7,7,30\n").output;
    return row.substr(row.rfind(',') + 1);
  };
  EXPECT_EQ(status({}), "exact\n");
  EXPECT_EQ(status({"--parts", "distance"}), "within_error\n");
}

TEST_F(CommandSide, RefusesOtherWords) {
  EXPECT_EQ(run({"query", "tree.ptree", "--side", "front"}, "1,1,1\n").status, 2);
  EXPECT_EQ(run({"query", "tree.ptree", "--normals", "up"}, "1,1,1\n").status, 2);
  EXPECT_EQ(run({"query", "tree.ptree", "--contains", "--normals", "outward"}, "1,1,1\n").status,
            2);
  EXPECT_EQ(run({"build", "mesh.obj", "-o", "new.ptree", "--side", "sheet"}).status, 2);
}

}  // namespace
}  // namespace planetree::tools
