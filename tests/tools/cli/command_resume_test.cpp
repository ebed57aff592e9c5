#include <gtest/gtest.h>

#include <string>

#include "octree/builder/tree_builder.h"
#include "storage/spill/work_directory.h"
#include "tests/storage/system/faulty_calls.h"
#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

class CommandResume : public Command {
 protected:
  static Outcome resume(std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"build",       "mesh.obj", "-o",     "new.ptree", "--resume",
                                       "--page-size", "4K",       "--meta", "generator="};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  // Leaves the checkpoint of a build whose disk failed once its triangles were ordered.
  static void interrupt() {
    class Watch final : public octree::BuildProgress {
     public:
      Result<void> progress(octree::BuildPhase phase, std::uint64_t, std::uint64_t) override {
        ordered = ordered || phase == octree::BuildPhase::kMatching;
        return {};
      }
      bool ordered = false;
    } watch;
    for (int call = 0; !watch.ordered; ++call) {
      storage::FaultyCalls calls;
      calls.fault = storage::FaultyCalls::Fault::kError;
      calls.fault_at = call;
      calls.every = true;
      octree::BuildOptions options;
      options.page_bytes = 4096;
      options.threads = 1;
      options.resume = true;
      const octree::BuildSeams seams{octree::kChunkTriangles, octree::kSectorTriangles, {}, calls};
      ASSERT_FALSE(octree::build_tree("mesh.obj", "new.ptree", options, watch, seams));
    }
    ASSERT_TRUE(fs::exists("new.ptree.work"));
  }
};

TEST_F(CommandResume, HelpNamesTheFlag) {
  const std::string help = run({"build", "--help"}).output;
  EXPECT_NE(help.find("--resume"), std::string::npos);
  EXPECT_NE(help.find("OUT.ptree.work"), std::string::npos);
}

TEST_F(CommandResume, ReportsThatThereIsNoCheckpoint) {
  const Outcome result = resume();
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.errors, "planetree: new.ptree: no checkpoint; building from the start\n");
  EXPECT_EQ(storage::read_bytes("new.ptree"), storage::read_bytes("tree.ptree"));
  EXPECT_FALSE(fs::exists("new.ptree.work"));
}

TEST_F(CommandResume, ResumesFromTheCheckpoint) {
  interrupt();
  const Outcome result = resume({"--json"});
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.errors, "planetree: new.ptree: resuming after ordering\n");
  const Json report = Json::parse(result.output);
  EXPECT_FALSE(report["seconds_by_phase"].contains("reading"));
  EXPECT_TRUE(report["seconds_by_phase"].contains("building_tree"));
  EXPECT_EQ(storage::read_bytes("new.ptree"), storage::read_bytes("tree.ptree"));
  EXPECT_FALSE(fs::exists("new.ptree.work"));
}

TEST_F(CommandResume, RepeatsTheNotesOfTheReader) {
  write_mesh("mesh.obj", kSide, "l 1 2\n");
  interrupt();
  const Outcome result = resume();
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(result.errors.starts_with(
      "planetree: new.ptree: resuming after ordering\n"
      "planetree: warning: mesh.obj: 1 point or line statement not read, the first 'l' in line "))
      << result.errors;
}

TEST_F(CommandResume, BeginsAgainWithOtherOptions) {
  interrupt();
  EXPECT_EQ(
      resume({"--float64"}).errors,
      "planetree: new.ptree: the checkpoint cannot be resumed: the options have changed; building "
      "from the start\n");
}

TEST_F(CommandResume, ReportsWhyTheCheckpointIsUnusable) {
  interrupt();
  write_mesh("mesh.obj", kSide, "\n");
  const Outcome result = resume();
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(
      result.errors,
      "planetree: new.ptree: the checkpoint cannot be resumed: the input has changed; building "
      "from the start\n");
  interrupt();
  const Outcome quiet = resume({"--force", "--strict", "--quiet"});
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.errors, "");
}

TEST_F(CommandResume, RefusesASecondProcess) {
  const auto other = storage::WorkDirectory::open("new.ptree.work");
  ASSERT_TRUE(other);
  const Outcome result = resume();
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.errors,
            "planetree: new.ptree.work: another process runs the same build; wait for it or name "
            "another output\n");
  EXPECT_FALSE(fs::exists("new.ptree"));
}

TEST_F(CommandResume, FollowsNoLinks) {
  fs::create_directory("precious");
  fs::create_directory_symlink("precious", "new.ptree.work");
  const Outcome result = resume();
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.errors,
            "planetree: new.ptree.work: the work directory's name is that of a file or link; "
            "remove it or "
            "choose another directory for temporary files\n");
  EXPECT_TRUE(fs::is_empty("precious"));
}

TEST_F(CommandResume, ReportsErrorsOfTheInputAsSuch) {
  const Outcome result = run({"build", "none.obj", "-o", "new.ptree", "--resume"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.errors,
            "planetree: none.obj: cannot open the file: No such file or directory; check the "
            "path\n");
  EXPECT_FALSE(fs::exists("new.ptree.work"));
}

}  // namespace
}  // namespace planetree::tools
