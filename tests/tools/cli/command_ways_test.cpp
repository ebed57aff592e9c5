#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "planetree/probe.h"
#include "tests/tools/cli/command_fixture.h"

// query --ray and query --sweep.
namespace planetree::tools {
namespace {

class WaysCommand : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    build_sample("solid.obj", "solid.ptree");
  }
  static std::vector<std::string> rows(std::vector<std::string> options, const std::string& input) {
    options.insert(options.begin(), {"query", "solid.ptree"});
    const Outcome result = run(options, input);
    EXPECT_EQ(result.status, 0) << result.errors;
    return lines_of(result.output);
  }
};

// A tetrahedron: three faces are the coordinate planes, and one leans.
TEST_F(WaysCommand, FindsFirstHits) {
  const auto found = rows({"--ray"}, "0.25,0.25,-2,0,0,4\n0.25,0.25,5,0,0,1\n");
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0],
            "x,y,z,dx,dy,dz,t,t_lower,t_upper,px,py,pz,nx,ny,nz,triangle,entering,status");
  EXPECT_TRUE(found[1].starts_with("0.25,0.25,-2,0,0,4,0.5,0.49999")) << found[1];
  EXPECT_TRUE(found[1].ends_with(",0.25,0.25,0,0,0,-1,0,1,exact")) << found[1];
  EXPECT_EQ(found[2], "0.25,0.25,5,0,0,1,inf,inf,inf,,,,,,,,,exact");
  const auto ranged = rows({"--ray"}, "0.25,0.25,-2,0,0,4,0.51,9\n0.25,0.25,-2,0,0,4,0,0.49\n");
  EXPECT_TRUE(ranged[0].starts_with("x,y,z,dx,dy,dz,t_min,t_max,t,"));
  EXPECT_TRUE(ranged[1].ends_with(",3,0,exact")) << ranged[1];
  EXPECT_TRUE(ranged[2].ends_with(",0,0.49,inf,inf,inf,,,,,,,,,exact")) << ranged[2];
}

TEST_F(WaysCommand, ListsAllHits) {
  const std::string ray = "0.25,0.25,-2,0,0,4\n";
  const auto found = rows({"--ray", "--hits", "9"}, ray + "5,5,5,0,0,1\n");
  ASSERT_EQ(found.size(), 4u);
  EXPECT_TRUE(found[1].ends_with(",0,1,exact"));
  EXPECT_TRUE(found[2].ends_with(",3,0,exact"));
  EXPECT_TRUE(found[3].ends_with(",inf,inf,inf,,,,,,,,,exact"));
  EXPECT_EQ(rows({"--ray", "--hits", "1"}, ray), rows({"--ray"}, ray));
  EXPECT_EQ(rows({"--ray", "--hits", "2"}, ray).size(), 3u);
  // Work that is spent leaves hits out; a row says so.
  const Outcome little =
      run({"query", "tree.ptree", "--ray", "--hits", "9", "--max-work", "2"}, "3,3,50,0,0,-1\n");
  EXPECT_TRUE(lines_of(little.output).back().ends_with(",degraded")) << little.output;
  EXPECT_EQ(run({"query", "solid.ptree", "--ray", "--hits", "0"}, ray).status, 2);
  EXPECT_EQ(run({"query", "solid.ptree", "--hits", "2"}, ray).status, 2);
}

// The last row says that hits may lack, and from where on.
TEST_F(WaysCommand, SaysThatHitsMayLack) {
  ASSERT_EQ(run({"generate", "ball.ply", "--shape", "sphere", "--triangles", "2K"}).status, 0);
  ASSERT_EQ(run({"build", "ball.ply", "-o", "ball.ptree", "--quiet"}).status, 0);
  const auto hits = [](const std::string& work) {
    const Outcome result = run(
        {"query", "ball.ptree", "--ray", "--hits", "9", "--format", "jsonl", "--max-work", work},
        "-200,0.3,0.4,1,0,0\n");
    std::vector<Json> rows;
    for (const std::string& line : lines_of(result.output)) rows.push_back(Json::parse(line));
    return rows;
  };
  const std::vector<Json> all = hits("10000");
  ASSERT_EQ(all.size(), 2u);
  std::size_t partial = 0;
  for (int work = 1; work < 30; ++work) {
    const std::vector<Json> found = hits(std::to_string(work));
    ASSERT_FALSE(found.empty());
    if (found == all) continue;
    EXPECT_EQ(found.back()["status"], "degraded");
    EXPECT_EQ(found.back()["triangle"], nullptr);
    EXPECT_LE(found.back()["t_lower"], all[found.size() - 1]["t"]);
    if (found.size() == 1) continue;
    ++partial;
    EXPECT_EQ(found[0], all[0]);
    EXPECT_EQ(found[1]["t_lower"], all[0]["t_lower"]);
  }
  EXPECT_GT(partial, 0u);
}

TEST_F(WaysCommand, FindsFirstContacts) {
  const auto found =
      rows({"--sweep"}, "0.25,0.25,-2,0.25,0.25,0,0.5\n-1,-1,-1,-1,-1,-2,0.25\n0,0,nan,0,0,1,1\n");
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0],
            "x0,y0,z0,x1,y1,z1,radius,t,t_lower,t_upper,px,py,pz,nx,ny,nz,triangle,feature,status");
  EXPECT_TRUE(found[1].starts_with("0.25,0.25,-2,0.25,0.25,0,0.5,0.7")) << found[1];
  EXPECT_TRUE(found[1].ends_with(",0.25,0.25,0,0,0,-1,0,face,exact")) << found[1];
  EXPECT_EQ(found[2], "-1,-1,-1,-1,-1,-2,0.25,inf,inf,inf,,,,,,,,,exact");
  EXPECT_EQ(found[3], "0,0,nan,0,0,1,1,inf,0,inf,,,,,,,,,bad_query");
}

// The same bits as the library gives, whatever the chunks and the threads.
TEST_F(WaysCommand, AnswersAsTheLibrary) {
  const auto model = Model::open("tree.ptree");
  ASSERT_TRUE(model);
  auto probe = Probe::create(*model);
  ASSERT_TRUE(probe);
  std::string input;
  std::vector<RayHit> expected;
  for (int i = 0; i < 200; ++i) {
    const Ray ray{{0.07 * i, 14 - 0.05 * i, 20}, {0.01 * (i % 7), 0.02 * (i % 5), -1}};
    expected.push_back(probe->first_hit(ray));
    for (const double number :
         {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y}) {
      char text[32];
      std::snprintf(text, sizeof text, "%.17g,", number);
      input += text;
    }
    input += "-1\n";
  }
  const Outcome result =
      run({"query", "tree.ptree", "--ray", "--format", "f64", "-o", "hits.f64"}, input);
  ASSERT_EQ(result.status, 0) << result.errors;
  const std::string bytes = text_of("hits.f64");
  ASSERT_EQ(bytes.size(), expected.size() * 20 * sizeof(double));
  std::size_t hits = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    double row[20];
    std::memcpy(row, bytes.data() + i * sizeof row, sizeof row);
    EXPECT_EQ(row[8], expected[i].t);
    EXPECT_EQ(row[9], expected[i].t_lower);
    EXPECT_EQ(row[10], expected[i].t_upper);
    if (expected[i].triangle == kNoTriangle) continue;
    EXPECT_EQ(row[17], static_cast<double>(expected[i].triangle));
    ++hits;
  }
  EXPECT_GT(hits, 100u);
  // Rows of answers are rays again.
  const std::string csv = run({"query", "tree.ptree", "--ray"}, input).output;
  EXPECT_EQ(run({"query", "tree.ptree", "--ray", "--threads", "2"}, csv).output, csv);
}

// What was hit lies on the surface.
TEST_F(WaysCommand, WritesHitsAsPly) {
  const std::string rays = "0.25,0.25,-2,0,0,4\n5,5,5,0,0,1\n";
  ASSERT_EQ(
      run({"query", "solid.ptree", "--ray", "--hits", "9", "--format", "ply", "-o", "hits.ply"},
          rays)
          .status,
      0);
  const std::string ply = text_of("hits.ply");
  EXPECT_TRUE(ply.starts_with(
      "ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty double x\nproperty double "
      "y\nproperty double z\nproperty double t\nproperty double nx\n"))
      << ply;
  const auto distances = lines_of(run({"query", "solid.ptree", "hits.ply"}).output);
  ASSERT_EQ(distances.size(), 3u);
  EXPECT_TRUE(distances[1].starts_with("0.25,0.25,0,0,0,")) << distances[1];
  EXPECT_TRUE(distances[2].starts_with("0.25,0.25,0.5,0,0,")) << distances[2];
  const std::string points = run({"query", "solid.ptree", "--format", "ply", "--parts", "distance"},
                                 "0.25,0.25,-2\nnan,0,0\n")
                                 .output;
  EXPECT_NE(points.find("element vertex 1\n"), std::string::npos);
  EXPECT_NE(points.find("property double distance\nend_header\n"), std::string::npos);
  EXPECT_EQ(points.size(), points.find("end_header\n") + 11 + 4 * sizeof(double));
  EXPECT_EQ(run({"query", "solid.ptree", "--format", "ply", "--contains"}, "1,2,3\n").status, 2);
  EXPECT_EQ(run({"query", "solid.ptree", "--format", "ply", "--parts", "side"}, "").status, 2);
}

TEST_F(WaysCommand, KeepsToLimits) {
  const std::string ray = "0.25,0.25,-2,0,0,4\n";
  EXPECT_TRUE(rows({"--ray", "--max-distance", "1"}, ray)[1].ends_with(",beyond_max_distance"));
  EXPECT_TRUE(
      rows({"--sweep", "--max-distance", "1"}, "0.25,0.25,-2,0.25,0.25,0,0.5\n")[1].ends_with(
          ",beyond_max_distance"));
  EXPECT_EQ(rows({"--ray", "--never-wait"}, ray), rows({"--ray"}, ray));
  const Outcome little =
      run({"query", "tree.ptree", "--sweep", "--max-work", "1"}, "4,4,20,4,4,-20,0.5\n");
  EXPECT_TRUE(lines_of(little.output).back().ends_with(",degraded")) << little.output;
}

TEST_F(WaysCommand, CountsInItsReport) {
  const Outcome rays = run({"query", "solid.ptree", "--ray", "--json", "--quiet"},
                           "0.25,0.25,-2,0,0,4\n5,5,5,1,0,0\n5,5,5,0,0,0\n");
  const Json report = Json::parse(lines_of(rays.errors).back());
  EXPECT_EQ(report["rays"], 3);
  EXPECT_EQ(report["hits"], 1);
  EXPECT_EQ(report["free"], 1);
  EXPECT_EQ(report["exact"], 2);
  EXPECT_EQ(report["bad_query"], 1);
  EXPECT_EQ(report["degraded"], 0);
  EXPECT_TRUE(report.contains("rays_per_second"));
  EXPECT_FALSE(report.contains("sides"));
  const Outcome sweeps = run({"query", "solid.ptree", "--sweep", "--json", "--quiet"},
                             "0.25,0.25,-2,0.25,0.25,0,0.5\n5,5,5,6,6,6,1\n");
  const Json contacts = Json::parse(lines_of(sweeps.errors).back());
  EXPECT_EQ(contacts["sweeps"], 2);
  EXPECT_EQ(contacts["hits"], 1);
  EXPECT_EQ(contacts["free"], 1);
}

TEST_F(WaysCommand, NamesTheLineThatItCannotRead) {
  const Outcome result =
      run({"query", "solid.ptree", "--ray", "-o", "out.csv"}, "0,0,0,1,1,1\n1,2,3,4,5\n");
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors,
            "planetree: standard input: line 2: it has fewer than six numbers; give "
            "x,y,z,dx,dy,dz, one ray a line\n");
  EXPECT_FALSE(fs::exists("out.csv"));
  const Outcome none = run({"query", "solid.ptree", "--sweep"});
  EXPECT_EQ(none.status, 1);
  EXPECT_EQ(none.errors,
            "planetree: standard input: it has no sweep; give at least one, as a line "
            "x0,y0,z0,x1,y1,z1,radius\n");
}

TEST_F(WaysCommand, RefusesOptionsOfPoints) {
  const std::vector<std::vector<std::string>> others = {
      {"--contains"},           {"--signed"},       {"--parts", "side"}, {"--side", "solid"},
      {"--normals", "outward"}, {"--nearest", "2"}, {"--within", "1"},   {"--contacts", "1"},
      {"--max-error", "1"}};
  for (const auto& other : others) {
    for (const char* way : {"--ray", "--sweep"}) {
      std::vector<std::string> arguments = {"query", "solid.ptree", way};
      arguments.insert(arguments.end(), other.begin(), other.end());
      const Outcome result = run(arguments, "0,0,0,1,1,1,1\n");
      EXPECT_EQ(result.status, 2) << other[0];
      EXPECT_NE(result.errors.find(other[0] + " excludes " + way), std::string::npos)
          << result.errors;
    }
  }
  EXPECT_EQ(run({"query", "solid.ptree", "--ray", "--sweep"}, "").status, 2);
  EXPECT_EQ(
      run({"query", "solid.ptree", "--ray", "--columns", "1,2,3"}, "").errors,
      "planetree: query: --columns: '1,2,3': give the different columns of x, y, z, dx, dy "
      "and dz, as X,Y,Z,DX,DY,DZ: names of the header, or numbers from 1; see planetree query "
      "--help\n");
}

}  // namespace
}  // namespace planetree::tools
