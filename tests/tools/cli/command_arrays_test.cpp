#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "tests/tools/arrays/read_npy.h"
#include "tests/tools/arrays/read_vtp.h"
#include "tests/tools/cli/command_fixture.h"

// NumPy arrays and VTK files that subcommands write.
namespace planetree::tools {
namespace {

class ArrayCommand : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    std::string text;
    for (int i = 0; i < 50; ++i)
      text += std::to_string(i % 9) + ".25," + std::to_string(i % 7) + ".5," +
              std::to_string(i % 5) + "\n";
    write("points.csv", text);
  }
  static std::string made(std::vector<std::string> words, const std::string& file) {
    for (const char* word : {"-o", file.c_str(), "--force", "--quiet"}) words.push_back(word);
    const Outcome outcome = run(words);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return text_of(file);
  }
  static std::vector<double> csv_column(const std::string& csv, const std::string& name) {
    std::vector<double> values;
    const auto lines = lines_of(csv);
    const auto field = [](const std::string& line, std::size_t wanted) {
      std::size_t at = 0;
      while (wanted-- > 0) at = line.find(',', at) + 1;
      return line.substr(at, line.find(',', at) - at);
    };
    std::size_t column = 0;
    while (field(lines.at(0), column) != name) ++column;
    for (std::size_t i = 1; i < lines.size(); ++i)
      values.push_back(std::stod(field(lines[i], column)));
    return values;
  }
};

TEST_F(ArrayCommand, WritesAnswersAsTheExtensionTells) {
  const std::string csv = made({"query", "tree.ptree", "points.csv"}, "out.csv");
  const ReadNpy array = read_npy(made({"query", "tree.ptree", "points.csv"}, "out.NPY"));
  EXPECT_EQ(array.names(), lines_of(csv).at(0));
  for (const char* name : {"x", "distance", "upper", "px", "nz", "triangle"})
    EXPECT_EQ(array.columns.at(name), csv_column(csv, name)) << name;
  const ReadVtp file = read_vtp(made({"query", "tree.ptree", "points.csv"}, "out.vtp"));
  EXPECT_EQ(file.points, 50u);
  EXPECT_EQ(file.values("PointData/distance"), csv_column(csv, "distance"));
  EXPECT_TRUE(made({"query", "tree.ptree", "points.csv"}, "out.ply").starts_with("ply\n"));
  EXPECT_TRUE(made({"query", "tree.ptree", "points.csv"}, "out.jsonl").starts_with("{\"x\":"));
  EXPECT_EQ(made({"query", "tree.ptree", "points.csv", "--format", "csv"}, "x.npy"), csv);
  EXPECT_EQ(made({"query", "tree.ptree", "points.csv"}, "answers"), csv);
  EXPECT_EQ(read_npy(made({"query", "tree.ptree", "points.csv", "--format", "npy"}, "y")).rows,
            50u);
}

TEST_F(ArrayCommand, RefusesNumpyArraysInPipes) {
  const std::string cause =
      "a NumPy array has its number of rows in front, which a pipe or a device cannot be told at "
      "the end; name a file by --output, or use --format f64\n";
  const Outcome outcome = run({"query", "tree.ptree", "points.csv", "--format", "npy"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.output, "");
  EXPECT_EQ(outcome.errors, "planetree: standard output: " + cause);
  ASSERT_EQ(::mkfifo("pipe.npy", 0600), 0);
  const int reader = ::open("pipe.npy", O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  ASSERT_GE(reader, 0);
  const Outcome piped = run({"query", "tree.ptree", "points.csv", "-o", "pipe.npy"});
  ::close(reader);
  EXPECT_EQ(piped.status, 2);
  EXPECT_EQ(piped.errors, "planetree: pipe.npy: " + cause);
}

TEST_F(ArrayCommand, WritesVtkFilesIntoPipes) {
  const Outcome outcome = run({"query", "tree.ptree", "points.csv", "--format", "vtp"});
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, made({"query", "tree.ptree", "points.csv"}, "out.vtp"));
}

TEST_F(ArrayCommand, WritesSidesOfQueriesAsAVtkFile) {
  const ReadVtp file =
      read_vtp(made({"query", "tree.ptree", "points.csv", "--contains"}, "sides.vtp"));
  EXPECT_EQ(file.points, 50u);
  EXPECT_EQ(file.values("Points").at(1), 0.5);
  EXPECT_EQ(file.values("PointData/side").size(), 50u);
  const Outcome outcome =
      run({"query", "tree.ptree", "points.csv", "--parts", "side", "-o", "out.vtp"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.errors.find("--format vtp needs points; give --contains"), std::string::npos);
}

TEST_F(ArrayCommand, WritesDeviationsWithColours) {
  const ReadNpy array = read_npy(made({"compare", "tree.ptree", "points.csv"}, "map.npy"));
  EXPECT_EQ(array.names(), "x,y,z,distance,red,green,blue");
  EXPECT_EQ(array.rows, 50u);
  const ReadVtp file = read_vtp(made({"compare", "tree.ptree", "points.csv"}, "map.vtp"));
  EXPECT_EQ(file.verts, 50u);
  EXPECT_EQ(file.scalars, "distance");
  EXPECT_EQ(file.values("PointData/distance"), array.columns.at("distance"));
  ASSERT_EQ(file.values("PointData/colour").size(), 150u);
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_EQ(file.values("Points")[3 * i + 2], array.columns.at("z")[i]);
    EXPECT_EQ(file.values("PointData/colour")[3 * i + 2], array.columns.at("blue")[i]);
  }
}

TEST_F(ArrayCommand, WritesMeasuredTrianglesAsAVtkFile) {
  const ReadVtp map =
      read_vtp(made({"compare", "tree.ptree", "mesh.obj", "--spacing", "4"}, "map.vtp"));
  EXPECT_GE(map.polys, kTriangles);
  EXPECT_EQ(map.verts, 0u);
  for (const double corner : map.values("Polys/connectivity"))
    EXPECT_LT(corner, static_cast<double>(map.points));
  const ReadVtp walls = read_vtp(made({"thickness", "tree.ptree", "--spacing", "4"}, "walls.vtp"));
  EXPECT_EQ(walls.scalars, "thickness");
  EXPECT_EQ(walls.points, 3 * walls.polys);
  const ReadNpy corners =
      read_npy(made({"thickness", "tree.ptree", "--spacing", "4"}, "walls.npy"));
  EXPECT_EQ(corners.rows, walls.points);
  EXPECT_EQ(corners.columns.at("thickness").size(), walls.points);
}

}  // namespace
}  // namespace planetree::tools
