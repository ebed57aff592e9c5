// A command that succeeds leaves standard error empty, whatever processors it may use.

#include <gtest/gtest.h>
#include <sched.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/storage/system/temporary_directory.h"

namespace planetree::tools {
namespace {

/// While it lives, this thread and the processes that it starts use one processor.
class OneProcessor {
 public:
  OneProcessor() {
    ::sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int i = 0; CPU_COUNT(&one) == 0; ++i)
      if (CPU_ISSET(i, &before_)) CPU_SET(i, &one);
    ::sched_setaffinity(0, sizeof one, &one);
  }
  OneProcessor(const OneProcessor&) = delete;
  OneProcessor& operator=(const OneProcessor&) = delete;
  ~OneProcessor() { ::sched_setaffinity(0, sizeof before_, &before_); }

 private:
  cpu_set_t before_;
};

class SilentSuccess : public testing::Test {
 protected:
  // Runs the program and returns what it writes to standard error.
  std::string errors_of(const std::string& arguments) {
    const std::string at = (folder_ / ".").string();
    const std::string line =
        "cd '" + at + "' && '" PLANETREE_COMMAND "' " + arguments + " >output 2>errors";
    EXPECT_EQ(std::system(line.c_str()), 0) << arguments;
    std::ifstream file(folder_ / "errors");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  void expect_silence(const std::string& threads) {
    EXPECT_EQ(errors_of("generate mesh.ply --triangles 20K --force"), "");
    EXPECT_EQ(errors_of("build mesh.ply -o tree.ptree --force " + threads), "");
    std::ofstream(folder_ / "points.csv") << "x,y,z\n1,2,3\n0,0,0\n100,0,0\n";
    EXPECT_EQ(errors_of("query tree.ptree points.csv " + threads), "");
    EXPECT_EQ(errors_of("query tree.ptree points.csv --contains " + threads), "");
    EXPECT_EQ(errors_of("inspect tree.ptree --levels"), "");
    EXPECT_EQ(errors_of("verify tree.ptree --full"), "");
    EXPECT_EQ(errors_of("touch tree.ptree --seconds 1"), "");
  }

 private:
  storage::TemporaryDirectory folder_;
};

TEST_F(SilentSuccess, WithTheThreadsOfTheMachine) { expect_silence(""); }

TEST_F(SilentSuccess, WithMoreThreadsThanProcessors) { expect_silence("--threads 64"); }

TEST_F(SilentSuccess, OnOneProcessor) {
  const OneProcessor one;
  expect_silence("");
  expect_silence("--threads 8");
}

}  // namespace
}  // namespace planetree::tools
