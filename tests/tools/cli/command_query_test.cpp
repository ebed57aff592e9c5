#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

class QueryCommand : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    build_sample("solid.obj", "solid.ptree");
  }
};

constexpr const char* kHeader =
    "x,y,z,distance,lower,upper,side,px,py,pz,nx,ny,nz,triangle,feature,status";

TEST_F(QueryCommand, FailsWithoutAPoint) {
  write("empty.f64", "");
  write("empty.ply",
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty "
        "float z\nend_header\n");
  const std::string cause = "it has no point; give at least one, as a line x,y,z\n";
  for (const char* text : {"", "x,y,z\n", "\n\n", "# nothing\n", "\xef\xbb\xbf"}) {
    const Outcome result = run({"query", "solid.ptree", "-o", "out.csv"}, text);
    EXPECT_EQ(result.status, 1) << text;
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(result.errors, "planetree: standard input: " + cause) << text;
  }
  for (const std::string name : {"empty.f64", "empty.ply"}) {
    const Outcome result = run({"query", "solid.ptree", name});
    EXPECT_EQ(result.status, 1) << name;
    EXPECT_EQ(result.errors, "planetree: " + name + ": " + cause);
  }
  EXPECT_FALSE(fs::exists("out.csv"));
}

TEST_F(QueryCommand, WritesAFileOnlyWhenItIsComplete) {
  const std::string points = "1,2,3\n4,5,6\n";
  const std::string expected = run({"query", "solid.ptree"}, points).output;
  const Outcome written = run({"query", "solid.ptree", "-", "-o", "out.csv"}, points);
  EXPECT_EQ(written.status, 0) << written.errors;
  EXPECT_EQ(written.output + written.errors, "");
  EXPECT_EQ(text_of("out.csv"), expected);
  const Outcome again = run({"query", "solid.ptree", "-o", "out.csv"}, "7,8,9\n");
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.errors.find("--force"), std::string::npos);
  const Outcome bad =
      run({"query", "solid.ptree", "--output", "out.csv", "--force"}, "7,8,9\nx,1,2\n");
  EXPECT_EQ(bad.status, 1);
  EXPECT_EQ(text_of("out.csv"), expected);
  EXPECT_EQ(run({"query", "solid.ptree", "-o", "out.csv", "--force"}, "7,8,9\n").status, 0);
  EXPECT_EQ(text_of("out.csv"), run({"query", "solid.ptree"}, "7,8,9\n").output);
  for (const auto& entry : fs::directory_iterator("."))
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
  EXPECT_EQ(run({"query", "solid.ptree", "-o", "-"}, points).output, expected);
}

TEST_F(QueryCommand, NeverReplacesItsInputs) {
  write("points.csv", "1,2,3\n");
  const std::string tree = text_of("solid.ptree");
  for (const std::string name : {"points.csv", "solid.ptree"}) {
    const Outcome result = run({"query", "solid.ptree", "points.csv", "-o", name, "--force"});
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.errors,
              "planetree: " + name + ": this is an input itself; name another output\n");
  }
  EXPECT_EQ(text_of("points.csv"), "1,2,3\n");
  EXPECT_EQ(text_of("solid.ptree"), tree);
}

TEST_F(QueryCommand, SignsDistances) {
  const std::string points = "0.25,0.25,0.0625\n0.25,0.25,-2\n";
  const auto lines = lines_of(run({"query", "solid.ptree", "--signed"}, points).output);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[0].starts_with("x,y,z,signed_distance,lower,upper,"));
  EXPECT_TRUE(lines[1].starts_with("0.25,0.25,0.0625,-0.0625,0.0624")) << lines[1];
  EXPECT_TRUE(lines[2].starts_with("0.25,0.25,-2,2,1.99")) << lines[2];
  EXPECT_EQ(run({"query", "solid.ptree", "--signed", "--contains"}, points).status, 2);
  EXPECT_EQ(run({"query", "solid.ptree", "--signed", "--parts", "distance"}, points).errors,
            "planetree: query: --signed needs the distance and the side; add both to --parts; see "
            "planetree query --help\n");
}

TEST_F(QueryCommand, ComputesOnlyTheRequestedParts) {
  const std::string point = "0.25,0.25,-2\n";
  const auto row = [&point](const std::string& parts) {
    return lines_of(run({"query", "solid.ptree", "--parts", parts}, point).output).back();
  };
  const std::string all = lines_of(run({"query", "solid.ptree"}, point).output).back();
  EXPECT_EQ(row("normal"), all);
  EXPECT_EQ(row("side, distance,normal"), all);
  EXPECT_EQ(row("side"), "0.25,0.25,-2,,,,outside,,,,,,,,,exact");
  EXPECT_TRUE(row("distance").starts_with("0.25,0.25,-2,2,"));
  EXPECT_TRUE(row("distance").ends_with(",,0.25,0.25,0,,,,0,face,exact"));
  EXPECT_TRUE(row("distance,side").ends_with(",outside,0.25,0.25,0,,,,0,face,exact"));
  for (const char* bad : {"", "sides", "distance;side", "distance,,side"})
    EXPECT_EQ(run({"query", "solid.ptree", "--parts", bad}, point).status, 2) << bad;
}

TEST_F(QueryCommand, LimitsTheWork) {
  const Outcome little = run({"query", "tree.ptree", "--max-work", "1"}, "4,4,9\n");
  EXPECT_EQ(little.status, 0) << little.errors;
  EXPECT_TRUE(lines_of(little.output).back().ends_with(",degraded"));
  EXPECT_TRUE(lines_of(run({"query", "tree.ptree", "--max-work", "1e6"}, "4,4,9\n").output)
                  .back()
                  .ends_with(",exact"));
  EXPECT_EQ(run({"query", "tree.ptree", "--max-work", "5G"}, "4,4,9\n").status, 2);
}

// The root page is always in memory, so that a small model is answered at once.
TEST_F(QueryCommand, AnswersWithoutWaiting) {
  const std::string point = "0.25,0.25,-2\n";
  EXPECT_EQ(run({"query", "solid.ptree", "--never-wait"}, point).output,
            run({"query", "solid.ptree"}, point).output);
  const auto lines = lines_of(run({"query", "tree.ptree", "--never-wait"}, "14,14,9\n").output);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], kHeader);
}

// A tetrahedron: three faces are the coordinate planes, and one leans.
TEST_F(QueryCommand, ListsTheTrianglesAboutPoints) {
  const std::string point = "0.125,0.25,-0.5\n";
  const Outcome all = run({"query", "solid.ptree", "--nearest", "9", "--format", "jsonl"}, point);
  ASSERT_EQ(all.status, 0) << all.errors;
  std::vector<Json> rows;
  std::istringstream lines(all.output);
  for (std::string line; std::getline(lines, line);) rows.push_back(Json::parse(line));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0]["triangle"], 0);
  EXPECT_EQ(rows[0]["distance"], 0.5);
  EXPECT_EQ(rows[0]["nz"], -1);
  EXPECT_EQ(rows[1]["triangle"], 2) << "the face in x = 0";
  EXPECT_EQ(rows[1]["nx"], -1);
  for (const Json& row : rows) {
    EXPECT_EQ(row["side"], "outside");
    EXPECT_EQ(row["status"], "exact");
  }
  const auto count_rows = [&](std::vector<std::string> options, const std::string& points) {
    options.insert(options.begin(), {"query", "solid.ptree"});
    const std::string text = run(options, points).output;
    return std::count(text.begin(), text.end(), '\n') - 1;
  };
  EXPECT_EQ(count_rows({"--nearest", "2"}, point + point), 4);
  EXPECT_EQ(count_rows({"--within", "0.5"}, point), 1);
  EXPECT_EQ(count_rows({"--within", "10"}, point), 4);
  EXPECT_EQ(count_rows({"--within", "10", "--nearest", "3"}, point), 3);
}

TEST_F(QueryCommand, SaysWhyAPointHasNoTriangle) {
  const Outcome result = run({"query", "solid.ptree", "--within", "0.1"}, "5,0,0\nnan,0,0\n");
  EXPECT_EQ(result.output, std::string(kHeader) +
                               "\n5,0,0,inf,0.1,inf,unknown,0,0,0,0,0,1,,face,beyond_max_distance\n"
                               "nan,0,0,inf,0,inf,unknown,0,0,0,0,0,1,,face,bad_query\n");
  EXPECT_EQ(run({"query", "solid.ptree", "--nearest", "0"}, "0,0,0\n").status, 2);
  EXPECT_EQ(run({"query", "solid.ptree", "--within", "1", "--contains"}, "0,0,0\n").status, 2);
}

// Inside, near a corner, each of the three faces has a contact. Outside there is one.
TEST_F(QueryCommand, ListsTheContactsOfPoints) {
  const Outcome result = run({"query", "solid.ptree", "--contacts", "0.25", "--parts", "distance"},
                             "0.1,0.15,0.2\n-2,9,9\n");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto lines = lines_of(result.output);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_EQ(lines[1].substr(0, 17), "0.1,0.15,0.2,0.1,");
  EXPECT_EQ(lines[2].substr(0, 18), "0.1,0.15,0.2,0.15,");
  EXPECT_EQ(lines[3].substr(0, 17), "0.1,0.15,0.2,0.2,");
  EXPECT_EQ(lines[4], "-2,9,9,inf,0.25,inf,,0,0,0,,,,,face,beyond_max_distance");
  // The distance rises by less than 0.1 between them.
  const std::vector<std::string> merged = lines_of(
      run({"query", "solid.ptree", "--contacts", "0.25", "--max-error", "0.2"}, "0.1,0.15,0.2\n")
          .output);
  EXPECT_EQ(merged.size(), 2u);
  EXPECT_EQ(run({"query", "solid.ptree", "--contacts", "1", "--within", "1"}, "0,0,0\n").status, 2);
}

TEST_F(QueryCommand, TakesColumns) {
  const std::string points = "id,a,b,c\n7,1,2,3\n";
  EXPECT_EQ(run({"query", "solid.ptree"}, points).status, 1);
  const std::string expected = run({"query", "solid.ptree"}, "1,2,3\n").output;
  EXPECT_EQ(run({"query", "solid.ptree", "--columns", "2,3,4"}, points).output, expected);
  EXPECT_EQ(run({"query", "solid.ptree", "--columns", "a,b,c"}, points).output, expected);
  EXPECT_EQ(run({"query", "solid.ptree", "--columns", "a,b"}, points).status, 2);
}

TEST_F(QueryCommand, NamesMisspelledOptions) {
  EXPECT_EQ(run({"query", "solid.ptree", "--ouput", "x"}).errors,
            "planetree: query: no option '--ouput'; did you mean --output?; see planetree query "
            "--help\n");
  EXPECT_EQ(run({"build", "mesh.obj", "--ouput=new.ptree"}).errors,
            "planetree: build: no option '--ouput'; did you mean --output?; see planetree build "
            "--help\n");
  EXPECT_EQ(run({"build", "mesh.obj", "-x", "new.ptree"}).errors,
            "planetree: build: no option '-x'; see planetree build --help\n");
  EXPECT_EQ(run({"biuld", "mesh.obj"}).errors,
            "planetree: no subcommand 'biuld'; did you mean build?; planetree --help lists them\n");
}

TEST_F(QueryCommand, TakesSizesInManyForms) {
  for (const char* size : {"64M", "1G", "1GiB", "1GB", "1e9", "1.5G"})
    EXPECT_EQ(run({"query", "solid.ptree", "--memory", size}, "1,2,3\n").status, 0) << size;
  for (const char* size : {"", "-1", "-64M", "1e30", "64 M", "1.5", "M"})
    EXPECT_EQ(run({"query", "solid.ptree", "--memory", size}, "1,2,3\n").status, 2) << size;
}

}  // namespace
}  // namespace planetree::tools
