#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

/// Attributes of triangles on the command line: build --keep, query --attributes, and what inspect
/// and verify say of them.
class CommandAttributes : public Command {
 protected:
  // A square of two triangles: red grows along x and green along y; u is x, v is y.
  static void write_square() {
    write("square.ply",
          "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
          "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
          "property float s\nproperty float t\nelement face 2\n"
          "property list uchar int vertex_indices\nproperty int part\nend_header\n"
          "0 0 0 0 0 9 0 0\n1 0 0 200 0 9 1 0\n1 1 0 200 100 9 1 1\n0 1 0 0 100 9 0 1\n"
          "3 0 1 2 -7\n3 0 2 3 40\n");
  }
  static Outcome build(const std::string& keep, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"build",  "square.ply", "-o",     "square.ptree", "--force",
                                       "--keep", keep,         "--json", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  static Outcome query(const std::string& points, std::vector<std::string> options) {
    options.insert(options.begin(), {"query", "square.ptree", "--attributes", "--quiet"});
    return run(options, points);
  }
};

TEST_F(CommandAttributes, AreInterpolatedInRows) {
  write_square();
  const Outcome built = build("color,uv,value", {"--value", "part"});
  ASSERT_EQ(built.status, 0) << built.errors;
  EXPECT_EQ(Json::parse(built.output)["attributes"], Json({"triangles", "color", "uv", "value"}));
  const Outcome rows = query("0.75 0.25 2\n0.25 0.75 1\n", {"--format", "jsonl"});
  ASSERT_EQ(rows.status, 0) << rows.errors;
  const std::size_t end = rows.output.find('\n');
  const Json first = Json::parse(rows.output.substr(0, end));
  const Json second = Json::parse(rows.output.substr(end));
  EXPECT_EQ(first["triangle"], 0);
  EXPECT_EQ(first["red"], 150);
  EXPECT_EQ(first["green"], 25);
  EXPECT_EQ(first["blue"], 9);
  EXPECT_EQ(first["alpha"], 255);
  EXPECT_EQ(first["u"], 0.75);
  EXPECT_EQ(first["v"], 0.25);
  EXPECT_EQ(first["value"], -7);
  EXPECT_EQ(second["triangle"], 1);
  EXPECT_EQ(second["value"], 40);
  const Outcome csv = query("0.75 0.25 2\n", {});
  EXPECT_NE(csv.output.find(",status,red,green,blue,alpha,u,v,value\n"), std::string::npos);
  EXPECT_NE(csv.output.find(",exact,150,25,9,255,0.75,0.25,-7\n"), std::string::npos);
}

TEST_F(CommandAttributes, AreEmptyWithoutATriangle) {
  write_square();
  ASSERT_EQ(build("color").status, 0);
  const Outcome far = query("0 0 9\n", {"--max-distance", "1"});
  ASSERT_EQ(far.status, 0) << far.errors;
  EXPECT_NE(far.output.find("beyond_max_distance,,,,\n"), std::string::npos) << far.output;
  const Outcome all = query("0.5 0.5 1\n", {"--nearest", "2"});
  EXPECT_EQ(std::count(all.output.begin(), all.output.end(), '\n'), 3);
}

TEST_F(CommandAttributes, AreRefusedWhereTheyCannotBeShown) {
  write_square();
  ASSERT_EQ(build("color").status, 0);
  const auto refusal = [&](const std::vector<std::string>& more) {
    const Outcome result = query("0.5 0.5 1\n", more);
    EXPECT_EQ(result.status, 2);
    return result.errors;
  };
  EXPECT_NE(refusal({"--format", "ply"}).find("has no attributes"), std::string::npos);
  EXPECT_NE(refusal({"-o", "out.ply"}).find("has no attributes"), std::string::npos);
  EXPECT_NE(refusal({"--parts", "side"}).find("add distance"), std::string::npos);
  EXPECT_NE(refusal({"--layers", "distance"}).find("the layer attributes"), std::string::npos);
}

TEST_F(CommandAttributes, NeedWhatTheFileKeeps) {
  const Outcome none = run({"query", "tree.ptree", "--attributes"}, "0 0 0\n");
  EXPECT_NE(none.status, 0);
  EXPECT_NE(none.errors.find("--keep color, uv or value"), std::string::npos) << none.errors;
  write_square();
  const Outcome unknown = build("colour");
  EXPECT_NE(unknown.status, 0);
  EXPECT_NE(unknown.errors.find("triangles, color, uv, value"), std::string::npos);
  const Outcome lacks = run({"build", "mesh.obj", "-o", "no.ptree", "--keep", "color"});
  EXPECT_NE(lacks.status, 0);
  EXPECT_NE(lacks.errors.find("colo"), std::string::npos) << lacks.errors;
  EXPECT_FALSE(fs::exists("no.ptree"));
}

TEST_F(CommandAttributes, RefuseANameOfValuesThatAreNotKept) {
  write_square();
  const auto refusal = [](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"build", "square.ply", "-o", "no.ptree"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome result = run(arguments);
    EXPECT_EQ(result.status, 2);
    EXPECT_FALSE(fs::exists("no.ptree"));
    return result.errors;
  };
  EXPECT_NE(refusal({"--value", "part"}).find("add --keep value"), std::string::npos);
  EXPECT_NE(refusal({"--value", "part", "--keep", "color,uv"}).find("add value to --keep"),
            std::string::npos);
  EXPECT_NE(refusal({"--value", "", "--keep", "value"}).find("give the name of a property"),
            std::string::npos);
}

TEST_F(CommandAttributes, NameWhatTheInputHas) {
  write_square();
  const Outcome lacks = build("value");
  EXPECT_EQ(lacks.status, 1);
  EXPECT_EQ(lacks.errors,
            "planetree: square.ply: no face property 'value'; faces have part; vertices have x, y, "
            "z, red, green and 3 more; name one of faces by --value\n");
}

TEST_F(CommandAttributes, AreInspectedAndVerified) {
  write_square();
  ASSERT_EQ(build("uv,value", {"--value", "part", "--page-size", "4K"}).status, 0);
  const Json seen = Json::parse(run({"inspect", "square.ptree", "--json", "--pages"}).output);
  EXPECT_EQ(seen["layers"]["attributes"]["pages"], 1);
  EXPECT_EQ(seen["attributes"], Json({"triangles", "uv", "value"}));
  EXPECT_GT(seen["bytes"]["attribute_pages"], 0);
  EXPECT_EQ(seen["bytes"]["within_pages"]["attributes"], 2 * (6 + 24 + 8));
  EXPECT_EQ(seen["issue_count"], 0);
  bool is_listed = false;
  for (const Json& page : seen["by_page"])
    if (page["kind"] == "attributes") {
      is_listed = true;
      EXPECT_EQ(page["attribute_triangles"], 2);
      const std::string number = std::to_string(page["page"].get<int>());
      const Json details =
          Json::parse(run({"inspect", "square.ptree", "--page", number, "--json"}).output);
      EXPECT_EQ(details["head"]["triangle_count"], 2);
      EXPECT_EQ(details["streams"].size(), 5u);
    }
  EXPECT_TRUE(is_listed);
  EXPECT_EQ(run({"verify", "square.ptree", "--full"}).status, 0);
  const std::string text = run({"inspect", "square.ptree"}).output;
  EXPECT_NE(text.find("attribute pages"), std::string::npos) << text;
  EXPECT_NE(text.find("attributes  triangles, uv, value\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace planetree::tools
