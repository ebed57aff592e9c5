#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tests/tools/values/ply_text.h"

namespace planetree::tools {
namespace {

class CommandThickness : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    // 10 by 10, 1 thick.
    write("slab.obj",
          "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 1\nv 10 0 1\nv 10 10 1\nv 0 10 1\n"
          "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
    built("slab.obj", "slab.ptree");
  }
  static void built(const std::string& mesh, const std::string& file) {
    const Outcome result = run({"build", mesh, "-o", file, "--quiet"});
    ASSERT_EQ(result.status, 0) << result.errors;
  }

  struct Row {
    double thickness = 0, lower = 0, upper = 0;
    std::string contact, status;
  };
  /// Measures at points, and reads the rows.
  static std::vector<Row> rows(const std::string& file, const std::string& points,
                               std::vector<std::string> options = {}) {
    options.insert(options.begin(), {"thickness", file, "-"});
    options.insert(options.end(), {"--quiet", "--csv", "rows.csv", "--force"});
    const Outcome result = run(options, points);
    EXPECT_EQ(result.status, 0) << result.errors;
    std::vector<std::string> lines = lines_of(text_of("rows.csv"));
    EXPECT_EQ(lines.front(), "x,y,z,thickness,lower,upper,qx,qy,qz,status");
    std::vector<Row> found;
    for (std::size_t i = 1; i < lines.size(); ++i) {
      std::vector<std::string> cells;
      std::istringstream line(lines[i]);
      for (std::string cell; std::getline(line, cell, ',');) cells.push_back(cell);
      EXPECT_EQ(cells.size(), 10u) << lines[i];
      found.push_back({std::stod(cells[3]), std::stod(cells[4]), std::stod(cells[5]),
                       cells[6] + ',' + cells[7] + ',' + cells[8], cells[9]});
    }
    return found;
  }
  static void expect_exact(const Row& row, double thickness) {
    EXPECT_EQ(row.status, "exact");
    EXPECT_LE(row.lower, thickness);
    EXPECT_GE(row.upper, thickness);
    EXPECT_NEAR(row.thickness, thickness, 1e-8);
    EXPECT_NEAR(row.upper, row.lower, 1e-7);
  }
};

TEST_F(CommandThickness, IsThatOfASlabAndFallsOffTowardsItsEdges) {
  const std::vector<Row> found =
      rows("slab.ptree", "5,5,1\n5,4,0\n0.2,5,1\n5,0.1,0\n0,5,0.5\n5,5,3\n");
  ASSERT_EQ(found.size(), 6u);
  expect_exact(found[0], 1);
  EXPECT_EQ(found[0].contact, "5,5,0");
  expect_exact(found[1], 1);
  expect_exact(found[2], 0.4);
  expect_exact(found[3], 0.2);
  expect_exact(found[4], 1);
  expect_exact(found[5], 1);  // at the nearest point of the surface
}

TEST_F(CommandThickness, IsTheDiameterOfASphere) {
  ASSERT_EQ(
      run({"generate", "sphere.ply", "--shape", "sphere", "--triangles", "3000", "--quiet"}).status,
      0);
  built("sphere.ply", "sphere.ptree");
  const Json report = Json::parse(
      run({"thickness", "sphere.ptree", "--spacing", "inf", "--json", "--quiet"}).output);
  const Json facts = Json::parse(run({"inspect", "sphere.ptree", "--json"}).output);
  const double diameter =
      facts["box"]["upper"][0].get<double>() - facts["box"]["lower"][0].get<double>();
  EXPECT_LE(report["max"], diameter * 1.0001);
  EXPECT_GT(report["min"]["thickness"], 0.88 * diameter) << "not all facets are regular";
  EXPECT_NEAR(report["mean"], diameter, 0.03 * diameter);
  EXPECT_LT(report["widest_interval"], 0.06 * diameter);
  EXPECT_EQ(report["beyond_max_thickness"], 0);
  EXPECT_EQ(report["degraded"], 0);
}

// A tube of outer radius 1 and inner radius 0.6.
TEST_F(CommandThickness, IsThatOfTheWallOfATube) {
  constexpr int kSides = 96;
  std::string tube;
  for (const double radius : {1.0, 0.6})
    for (const int z : {-3, 3})
      for (int i = 0; i < kSides; ++i)
        tube += fmt::format("v {} {} {}\n", radius * std::cos(2 * M_PI * i / kSides),
                            radius * std::sin(2 * M_PI * i / kSides), z);
  const auto quad = [&tube](int a, int b, int c, int d) {
    tube += fmt::format("f {} {} {} {}\n", a + 1, b + 1, c + 1, d + 1);
  };
  for (int i = 0; i < kSides; ++i) {
    const int j = (i + 1) % kSides;
    quad(i, j, kSides + j, kSides + i);                                    // outside
    quad(2 * kSides + j, 2 * kSides + i, 3 * kSides + i, 3 * kSides + j);  // inside
    quad(j, i, 2 * kSides + i, 2 * kSides + j);                            // bottom
    quad(kSides + i, kSides + j, 3 * kSides + j, 3 * kSides + i);          // top
  }
  write("tube.obj", tube);
  built("tube.obj", "tube.ptree");
  std::string points;
  for (const double radius : {1.0, 0.6})
    for (int i = 0; i < 5; ++i) {
      const double angle = 2 * M_PI * (7 * i + 0.5) / kSides;
      points += fmt::format("{},{},{}\n", radius * std::cos(angle), radius * std::sin(angle), 0.1);
    }
  for (const Row& row : rows("tube.ptree", points)) {
    EXPECT_NEAR(row.thickness, 0.4, 0.002);
    EXPECT_LE(row.lower, 0.402);
    EXPECT_GE(row.upper, 0.398);
    EXPECT_LT(row.upper - row.lower, 0.02);
  }
}

TEST_F(CommandThickness, MarksPointsWithoutAWall) {
  write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  built("sheet.obj", "sheet.ptree");
  const Row sheet = rows("sheet.ptree", "0.5,0.5,0\n").at(0);
  EXPECT_EQ(sheet.status, "beyond_max_thickness");
  EXPECT_EQ(sheet.contact, ",,");
  EXPECT_TRUE(std::isinf(sheet.thickness));
  EXPECT_NEAR(sheet.lower, std::sqrt(2), 1e-6);
  const Row limited = rows("slab.ptree", "5,5,1\n", {"--max-thickness", "0.5"}).at(0);
  EXPECT_EQ(limited.status, "beyond_max_thickness");
  EXPECT_NEAR(limited.lower, 0.5, 1e-6);
  EXPECT_EQ(rows("slab.ptree", "nan,0,0\n").at(0).status, "bad_query");
}

TEST_F(CommandThickness, SeesEdgesThatBendByMoreThanTheAngle) {
  // A roof: two slopes that rise by 20 degrees to a ridge, and a floor far below.
  const double rise = std::tan(20 * M_PI / 180);
  write("roof.obj", fmt::format("v -1 -5 0\nv 0 -5 {0}\nv 1 -5 0\nv -1 5 0\nv 0 5 {0}\nv 1 5 0\n"
                                "v -1 -5 -9\nv 1 -5 -9\nv -1 5 -9\nv 1 5 -9\n"
                                "f 1 2 5 4\nf 2 3 6 5\nf 1 4 9 7\nf 3 8 10 6\nf 7 9 10 8\n"
                                "f 1 7 8 3 2\nf 4 5 6 10 9\n",
                                rise));
  built("roof.obj", "roof.ptree");
  // Near the ridge, where the other slope bends by 40 degrees.
  const std::string point = fmt::format("-0.05,0,{}\n", rise * 0.95);
  const double across = 0.05 / std::cos(20 * M_PI / 180);
  const Row narrow = rows("roof.ptree", point, {"--min-angle", "15"}).at(0);
  EXPECT_NEAR(narrow.thickness, 2 * across / std::tan(20 * M_PI / 180), 1e-6);
  const Row wide = rows("roof.ptree", point, {"--min-angle", "45"}).at(0);
  EXPECT_GT(wide.thickness, 1) << "the slope does not count, the side walls do";
}

TEST_F(CommandThickness, MeasuresTheModelByItself) {
  const Outcome result = run({"thickness", "slab.ptree", "--spacing", "0.5", "--thinner-than",
                              "0.5", "-o", "out.ply", "--html", "out.html", "--json", "--quiet"});
  ASSERT_EQ(result.status, 0) << result.errors;
  const Json report = Json::parse(result.output);
  EXPECT_EQ(report["exact"], report["points"]);
  EXPECT_NEAR(report["percentiles"]["p95"], 1, 1e-9);
  EXPECT_NEAR(report["max"], 1, 1e-9);
  // On the large sides a band of 0.25 along the edges is thinner, and of the small ones half.
  const double large = 2 * (100 - 9.5 * 9.5), small = 4 * (10 * 1 - 9.5 * 0.5);
  EXPECT_NEAR(report["thin"]["share"], (large + small) / 240, 0.05);
  const PlyText ply(text_of("out.ply"));
  ASSERT_TRUE(ply.is_whole) << ply.header;
  EXPECT_EQ(ply.triangles.size(), report["points"]);
  EXPECT_EQ(ply.points.size(), 3 * ply.triangles.size());
  EXPECT_NE(text_of("out.html").find("id=\"thickness\""), std::string::npos);
}

TEST_F(CommandThickness, MeasuresAtSomeOfTheParts) {
  const auto points = [](const char* every) {
    const Outcome result =
        run({"thickness", "slab.ptree", "--spacing", "0.5", "--every", every, "--json", "--quiet"});
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output)["points"].get<int>();
  };
  EXPECT_EQ(points("7"), (points("1") + 6) / 7);
  EXPECT_EQ(run({"thickness", "slab.ptree", "--every", "0"}).status, 2);
}

TEST_F(CommandThickness, DoesNotDependOnThreads) {
  const auto measured = [](const char* threads) {
    const Outcome result = run({"thickness", "tree.ptree", "--spacing", "inf", "--csv", "rows.csv",
                                "--force", "--quiet", "--threads", threads, "--memory", "64M"});
    EXPECT_EQ(result.status, 0) << result.errors;
    return text_of("rows.csv");
  };
  EXPECT_EQ(measured("1"), measured("3"));
}

TEST_F(CommandThickness, RefusesWhatItCannotMeasure) {
  EXPECT_EQ(run({"thickness", "slab.obj"}).status, 1);
  EXPECT_EQ(run({"thickness", "slab.ptree", "-"}, "").status, 1);
  EXPECT_EQ(run({"thickness", "none.ptree"}).status, 2);
  EXPECT_EQ(run({"thickness", "slab.ptree", "--min-angle", "90"}).status, 2);
  EXPECT_EQ(run({"thickness", "slab.ptree", "--spacing", "0"}).status, 2);
  EXPECT_EQ(run({"thickness", "slab.ptree", "--max-thickness", "0"}).status, 2);
  EXPECT_EQ(run({"thickness", "slab.ptree", "--csv", "-"}).status, 2);
  EXPECT_EQ(run({"thickness", "slab.ptree", "--csv", "slab.ptree", "--force"}).status, 2);
  EXPECT_EQ(run({"thickness", "slab.ptree", "-", "--memory", "64K"}, "0,0,0\n").status, 3);
  EXPECT_EQ(run({"thickness", "slab.ptree", "-", "--csv", "rows.csv"}, "1,2\n").status, 1);
  EXPECT_FALSE(fs::exists("rows.csv"));
}

}  // namespace
}  // namespace planetree::tools
