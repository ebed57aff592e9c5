// Commands that take a mesh of several files.

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

class CommandFiles : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    write_mesh("a.obj", 4);
    write_mesh("b.obj", 3, "l 1 2\nf 1 2 999\n");
    write_mesh("c.obj", 2, "f 1 2\n");
    // The same statements in one file; each part begins with its own vertices.
    const std::string a = text_of("a.obj"), b = text_of("b.obj"), c = text_of("c.obj");
    write("joined.obj", a + relative(b) + relative(c));
  }
  // With indices from the last vertex of the part, so that the part can stand behind others.
  static std::string relative(const std::string& obj) {
    std::istringstream lines(obj);
    long vertices = 0;
    std::string line, text;
    std::vector<std::string> faces;
    while (std::getline(lines, line)) {
      if (line.starts_with("v ")) {
        ++vertices;
        text += line + '\n';
      } else {
        faces.push_back(line);
      }
    }
    for (const std::string& face : faces) {
      std::istringstream words(face);
      std::string word;
      words >> word;
      text += word;
      for (long index = 0; words >> index;)
        text += ' ' + std::to_string(index > vertices ? index : index - vertices - 1);
      text += '\n';
    }
    return text;
  }
};

TEST_F(CommandFiles, BuildWritesTheFileOfTheJoinedMesh) {
  ASSERT_EQ(run({"build", "joined.obj", "-o", "joined.ptree"}).status, 0);
  const Outcome built = run({"build", "a.obj", "b.obj", "c.obj", "-o", "files.ptree", "--json"});
  ASSERT_EQ(built.status, 0) << built.errors;
  EXPECT_EQ(storage::read_bytes("files.ptree"), storage::read_bytes("joined.ptree"));
  EXPECT_EQ(built.errors,
            "planetree: warning: 3 meshes: b.obj: 1 point or line statement not read, the first "
            "'l' in line 35\n"
            "planetree: warning: 3 meshes: 2 triangles of bad records skipped, the first: b.obj: "
            "line 36: vertex index 999 is out of range, the mesh has 16 vertices; repair the mesh, "
            "or use --strict to refuse it\n");
  const Json report = Json::parse(built.output);
  EXPECT_EQ(report["input"], (std::vector<std::string>{"a.obj", "b.obj", "c.obj"}));
  EXPECT_EQ(report["first_skipped"], 32 + 18);
  EXPECT_EQ(report["skipped"], 2);
}

TEST_F(CommandFiles, ErrorsNameTheFile) {
  Outcome refused = run({"build", "a.obj", "b.obj", "none.obj", "-o", "files.ptree"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(refused.errors.starts_with("planetree: none.obj: no such file")) << refused.errors;
  refused = run({"build", "a.obj", "b.obj", "c.obj", "-o", "files.ptree", "--strict"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(refused.errors.starts_with("planetree: b.obj: ")) << refused.errors;
  refused = run({"build", "a.obj", "b.obj", "-o", "b.obj", "--force"});
  EXPECT_TRUE(refused.errors.starts_with("planetree: b.obj: this is the input itself"))
      << refused.errors;
  refused = run({"build", "a.obj", "b.obj", "-o", "x.ptree", "--box", "50,50,50,60,60,60"});
  EXPECT_TRUE(refused.errors.starts_with("planetree: 2 meshes: ")) << refused.errors;
}

TEST_F(CommandFiles, ShardsWriteTheFileOfTheJoinedMesh) {
  ASSERT_EQ(run({"build", "joined.obj", "-o", "joined.ptree"}).status, 0);
  const Outcome planned =
      run({"shard", "plan", "a.obj", "b.obj", "c.obj", "-o", "job", "--shards", "3"});
  ASSERT_EQ(planned.status, 0) << planned.errors;
  EXPECT_TRUE(planned.errors.find("3 meshes: 2 triangles of bad records skipped") !=
              std::string::npos)
      << planned.errors;
  fs::rename("c.obj", "c.away");
  ASSERT_EQ(run({"shard", "map", "job", "0"}).status, 0);
  const Outcome missing = run({"shard", "map", "job", "2"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_NE(missing.errors.find("c.obj: cannot open "), std::string::npos) << missing.errors;
  fs::rename("c.away", "c.obj");
  for (const char* step : {"map", "reduce"})
    for (const char* number : {"0", "1", "2"})
      ASSERT_EQ(run({"shard", step, "job", number}).status, 0);
  ASSERT_EQ(run({"shard", "merge", "job", "-o", "shards.ptree"}).status, 0);
  EXPECT_EQ(storage::read_bytes("shards.ptree"), storage::read_bytes("joined.ptree"));
}

}  // namespace
}  // namespace planetree::tools
