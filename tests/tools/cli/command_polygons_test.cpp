#include <gtest/gtest.h>

#include <string>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

/// What the command says about polygons that are odd.
class CommandPolygons : public Command {};

TEST_F(CommandPolygons, BuildNamesTheFirstOddPolygons) {
  write("odd.obj",
        "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 1\n"
        "f 1 2 3 4\nf 1 3 2 4\nf 2 5 4 1\nf 1 3 2 4 1\n");
  const Outcome result = run({"build", "odd.obj", "-o", "odd.ptree", "--json", "--strict"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.errors,
            "planetree: warning: odd.obj: 1 polygon neither convex nor flat split as seen along an "
            "axis, the first: line 8: a polygon of 4 corners is neither convex nor flat; split "
            "them before the export to choose their triangles\n"
            "planetree: warning: odd.obj: 2 polygons split into fans that may reach beyond them, "
            "the first: line 7: a polygon of 4 corners crosses itself; split them before the "
            "export\n");
  const Json report = Json::parse(result.output);
  EXPECT_EQ(report["nonplanar_polygons"], 1);
  EXPECT_EQ(report["fanned_polygons"], 2);
  EXPECT_EQ(report["triangles"], 9);
}

TEST_F(CommandPolygons, BuildSaysNothingOfPolygonsThatAreNotConvex) {
  write("dart.obj",
        "v 4 0 0\nv 1 1 0\nv 0 4 0\nv 0 0 0\nv 1 4 1\nf 1 2 3 4\nf 1 2 3 4 1\nf 1 2 5\n");
  const Outcome result = run({"build", "dart.obj", "-o", "dart.ptree", "--json", "--strict"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.errors, "");
  const Json report = Json::parse(result.output);
  EXPECT_EQ(report["nonplanar_polygons"], 0);
  EXPECT_EQ(report["fanned_polygons"], 0);
  EXPECT_EQ(report["triangles"], 6);
}

}  // namespace
}  // namespace planetree::tools
