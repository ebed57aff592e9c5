#include "tests/tools/cli/killed_builds.h"

#include <gtest/gtest.h>

namespace planetree::tools {
namespace {

#ifdef PLANETREE_COMMAND
#ifdef NDEBUG
constexpr const char* kTriangles = "200K";
#else
constexpr const char* kTriangles = "20K";  // builds are slow here
#endif

class KilledBuild : public testing::TestWithParam<const char*> {};

TEST_P(KilledBuild, LeavesTheOldOrTheCompleteFileAndAtMostACheckpoint) {
  KilledBuilds builds(PLANETREE_COMMAND, 1);
  if (!builds.has_unnamed_files()) GTEST_SKIP() << "this file system has no files without names";
  ASSERT_EQ(builds.prepare(kTriangles, GetParam()), "");
  constexpr unsigned kCount = 20;
  unsigned killed = 0, resumable = 0;
  for (unsigned i = 0; i < kCount; ++i) {
    const bool resume = i % 4 == i / 4 % 2;  // both with and without a file to replace
    const KilledBuilds::Left left = builds.kill_one(i, kCount, resume);
    EXPECT_EQ(left.wrong, "");
    killed += left.killed ? 1 : 0;
    resumable += left.work ? 1 : 0;
  }
  EXPECT_GE(killed, kCount / 4) << "of the others were done before";
  EXPECT_GE(resumable, 1u) << "had kept something";
}

INSTANTIATE_TEST_SUITE_P(Holes, KilledBuild, testing::Values("0", "100"));
#endif

}  // namespace
}  // namespace planetree::tools
