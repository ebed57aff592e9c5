#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tests/tools/points/las_bytes.h"

// Every subcommand that reads points reads them from LAS files.
namespace planetree::tools {
namespace {

class LasCommand : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    LasFile file;
    file.minor = 4;
    file.format = 7;
    file.scale = {0.125, 0.25, 0.5};
    file.offset = {-1, 0, 2};
    std::string text = "x,y,z\n";
    for (std::int32_t i = 0; i < 100; ++i) {
      file.points.push_back({i, 2 * i % 70, 3 * i % 40 - 20});
      const auto& point = file.points.back();
      text += std::to_string(point[0] * 0.125 - 1) + ',' + std::to_string(point[1] * 0.25) + ',' +
              std::to_string(point[2] * 0.5 + 2) + '\n';
    }
    write("points.las", las_bytes(file));
    write("points.csv", text);
  }
};

TEST_F(LasCommand, AnswersAsForTheSamePointsInText) {
  const Outcome las = run({"query", "tree.ptree", "points.las"});
  EXPECT_EQ(las.status, 0) << las.errors;
  EXPECT_EQ(lines_of(las.output).size(), 101u);
  EXPECT_EQ(las.output, run({"query", "tree.ptree", "points.csv"}).output);
  EXPECT_EQ(las.output, run({"query", "tree.ptree"}, text_of("points.las")).output);
}

TEST_F(LasCommand, ComparesAndMeasuresThePoints) {
  for (const std::string command : {"compare", "thickness"}) {
    const auto report = [&command](const std::string& points) {
      const Outcome outcome =
          run({command, "tree.ptree", points, "--json", "-o", "map.ply", "--force", "--quiet"});
      EXPECT_EQ(outcome.status, 0) << outcome.errors;
      return text_of("map.ply");
    };
    const std::string map = report("points.las");
    EXPECT_NE(map.find("element vertex 100\n"), std::string::npos) << command;
    EXPECT_EQ(map, report("points.csv")) << command;
  }
  const Outcome trade =
      run({"trade", "tree.ptree", "--points", "points.las", "--json", "--count", "50", "--quiet"});
  EXPECT_EQ(trade.status, 0) << trade.errors;
}

TEST_F(LasCommand, NamesTheByteOfDamage) {
  const std::string bytes = text_of("points.las");
  write("cut.las", bytes.substr(0, bytes.size() - 1));
  EXPECT_EQ(run({"query", "tree.ptree", "cut.las", "-o", "out.csv"}).errors,
            "planetree: cut.las: at byte " + std::to_string(bytes.size() - 1) +
                ": the file ends after 99 of 100 points; copy or export it again\n");
  EXPECT_FALSE(fs::exists("out.csv"));
}

}  // namespace
}  // namespace planetree::tools
