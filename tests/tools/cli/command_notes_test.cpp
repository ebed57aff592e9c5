#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

TEST_F(Command, BuildTellsWhatTheReaderPassedOver) {
  write_mesh("notes.obj", 3, "l 1 2\nsurf 0 1 0 1 1 2\nl 2 3\n");
  const Outcome result = run({"build", "notes.obj", "-o", "notes.ptree", "--json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(
      result.errors,
      "planetree: warning: notes.obj: 1 statement of curves, patches or other files not read, the "
      "first 'surf' in line 36; export them as faces\n"
      "planetree: warning: notes.obj: 2 point or line statements not read, the first 'l' in line "
      "35\n");
  const Json report = Json::parse(result.output);
  ASSERT_EQ(report["notes"].size(), 2u);
  EXPECT_TRUE(report["notes"][0].get<std::string>().starts_with("1 statement of curves"));
}

// Of each kind one line, with the file once and the position once.
TEST_F(Command, BuildNamesFileAndPositionOfAMeshFaultOnce) {
  const std::pair<std::string, std::string> faults[] = {
      {std::string(80, ' ') + std::string("\5\0\0\0", 4),
       "byte 80: the count is 5 facets, the file has bytes for 0: it is truncated; copy or export "
       "it "
       "again\n"},
      {"solid a\nvertex 0 0 0\n",
       "line 2: 'vertex' is not expected here; copy or export the STL again\n"},
      {"Kaydara FBX Binary",
       "byte 0: the file is an FBX file; open it in the program it is from and export PLY, STL, "
       "OBJ, OFF or glTF\n"}};
  for (const auto& [bytes, message] : faults) {
    std::ofstream("fault.stl", std::ios::binary) << bytes;
    const Outcome result = run({"build", "fault.stl", "-o", "fault.ptree"});
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.errors, "planetree: fault.stl: " + message);
  }
}

TEST_F(Command, BuildReadsAllDigitsOnDemand) {
  std::ofstream("digits.ply") << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                 "property float y\nproperty float z\nelement face 1\n"
                                 "property list uchar int vertex_indices\nend_header\n"
                                 "0 5155487.512 0\n1 5155487.512 0\n0 5155488.5 0\n3 0 1 2\n";
  const Outcome rounded = run({"build", "digits.ply", "-o", "digits.ptree"});
  EXPECT_EQ(rounded.status, 0);
  EXPECT_EQ(
      rounded.errors,
      "planetree: warning: digits.ply: 2 coordinates of more digits than the declared float "
      "holds, the first '5155487.512' in line 10, rounded; --float64 reads them as doubles\n");
  const Outcome whole = run({"build", "digits.ply", "-o", "digits.ptree", "--force", "--float64"});
  EXPECT_EQ(whole.errors, "");
  EXPECT_NE(run({"query", "digits.ptree"}, "0,5155487.512,1\n").output.find(",1,1,"),
            std::string::npos);
}

}  // namespace
}  // namespace planetree::tools
