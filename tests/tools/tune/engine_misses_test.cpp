// Replays what the engine looked up, and compares the misses with those of the engine.

#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/cli/captured_console.h"
#include "tests/tools/tune/engine_run.h"
#include "tools/cli/policy_option.h"

namespace planetree::tools {
namespace {

class EngineMisses : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new storage::TemporaryDirectory;
    model_ = *folder_ / "statue.ptree";
    const std::string mesh = (*folder_ / "statue.ply").string();
    ASSERT_EQ(run({"generate", mesh, "--triangles", "20K", "--quiet"}).status, 0);
    ASSERT_EQ(run({"build", mesh, "-o", model_.string(), "--page-size", "4K"}).status, 0);
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::vector<Vec3> path(TouchMotion motion) { return engine_path(model_, motion, 1500); }

  static void expect_equal_misses(const std::vector<Vec3>& points, bool is_batch) {
    std::set<std::uint32_t> sizes;
    std::set<std::uint64_t> all_misses;
    for (const EngineComparison& compared :
         compare_engine({model_, points, is_batch}, 8, std::uint64_t{2} << 20)) {
      sizes.insert(compared.frames);
      all_misses.insert(compared.engine);
      EXPECT_EQ(compared.replayed, compared.engine)
          << name_of(compared.policy) << ", " << compared.frames << " frames";
      EXPECT_LE(compared.optimum, compared.engine) << name_of(compared.policy);
    }
    EXPECT_GE(sizes.size(), 8u);
    EXPECT_GT(all_misses.size(), 4u) << "policies and sizes differ";
  }

  static inline storage::TemporaryDirectory* folder_ = nullptr;
  static inline std::filesystem::path model_;
};

TEST_F(EngineMisses, AreReplayedOnAGlide) { expect_equal_misses(path(TouchMotion::kGlide), false); }

TEST_F(EngineMisses, AreReplayedOnAScratch) {
  expect_equal_misses(path(TouchMotion::kScratch), false);
}

TEST_F(EngineMisses, AreReplayedOnJumps) {
  expect_equal_misses(path(TouchMotion::kTeleport), false);
}

TEST_F(EngineMisses, AreReplayedOfABatch) {
  std::vector<Vec3> points;
  for (const TouchMotion motion : {TouchMotion::kTeleport, TouchMotion::kScratch})
    for (const Vec3& point : path(motion)) points.push_back(point);
  expect_equal_misses(points, true);
}

}  // namespace
}  // namespace planetree::tools
