// Replays what the engine looked up, and compares the misses with those of the engine.

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/cli/captured_console.h"
#include "tools/cli/policy_option.h"
#include "tools/session/session_path.h"
#include "tools/tune/miss_curves.h"
#include "tools/tune/policy_replay.h"
#include "tools/tune/trace_analysis.h"

namespace planetree::tools {
namespace {

/// What a run of queries that wait cost.
struct EngineRun {
  std::uint32_t frames = 0;
  std::uint64_t misses = 0;
  TraceAnalysis analysis;
};

class EngineMisses : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new storage::TemporaryDirectory;
    model_path_ = *folder_ / "statue.ptree";
    const std::string mesh = (*folder_ / "statue.ply").string();
    ASSERT_EQ(run({"generate", mesh, "--triangles", "20K", "--quiet"}).status, 0);
    ASSERT_EQ(run({"build", mesh, "-o", model_path_.string(), "--page-size", "4K"}).status, 0);
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::vector<Vec3> path(TouchMotion motion) {
    const auto model = Model::open(model_path_);
    auto probe = Probe::create(*model);
    return touch_path(*model, *probe, motion, 1500);
  }

  /// Answers the points with a model within a budget: each alone, or together as a batch.
  static EngineRun answer(const std::vector<Vec3>& points, bool is_batch, EvictionPolicy policy,
                          std::uint64_t budget, bool traces) {
    OpenOptions options;
    options.memory_budget_bytes = budget;
    options.max_probes = 1;
    options.policy = policy;
    options.page_trace_capacity = traces ? std::uint32_t{1} << 19 : 0;
    // Without fetch threads, and thus one reader.
    const auto model =
        query::ModelState::open_model(model_path_, options, {.starts_fetching = false});
    EXPECT_TRUE(model) << model.error().text;
    auto probe = Probe::create(*model);
    const std::uint64_t before = model->stats().pages_read;
    if (is_batch) {
      std::vector<ClosestPoint> answers(points.size());
      probe->closest_points(points, answers);
    } else {
      for (std::size_t i = 0; i < points.size(); ++i) {
        (void)probe->closest_point(points[i]);
        if (i % 7 == 0) (void)probe->contains(points[i / 2]);
      }
    }
    EngineRun run;
    run.frames = query::ModelState::of(*model).cache().stats().frame_count;
    run.misses = model->stats().pages_read - before;
    std::array<PageAccess, 1024> accesses;
    for (std::size_t got = accesses.size(); traces && got == accesses.size();) {
      got = model->drain_page_trace(accesses);
      for (std::size_t i = 0; i < got; ++i) run.analysis.add(accesses[i]);
    }
    EXPECT_EQ(model->stats().page_trace_dropped, 0u);
    return run;
  }

  void expect_equal_misses(const std::vector<Vec3>& points, bool is_batch) {
    OpenOptions options;
    options.max_probes = 1;
    const std::uint64_t least = *query::ModelState::min_budget_bytes(model_path_, options);
    constexpr std::uint64_t kPlenty = std::uint64_t{64} << 20;
    const EngineRun traced = answer(points, is_batch, EvictionPolicy::kClock, kPlenty, true);
    const References& references = traced.analysis.references();
    EXPECT_EQ(traced.misses, references.compulsory());
    std::set<std::uint32_t> sizes;
    std::set<std::uint64_t> all_misses;
    for (std::uint64_t step = 0; step < 8; ++step) {
      const std::uint64_t budget = least + step * step * 2 * 4096;
      for (const EvictionPolicy policy : kAllPolicies) {
        const EngineRun engine = answer(points, is_batch, policy, budget, false);
        sizes.insert(engine.frames);
        all_misses.insert(engine.misses);
        EXPECT_EQ(replayed_misses(references, policy, engine.frames), engine.misses)
            << name_of(policy) << ", " << engine.frames << " frames";
      }
    }
    EXPECT_GE(sizes.size(), 8u);
    EXPECT_GT(all_misses.size(), 8u) << "policies and sizes differ";
  }

  static inline storage::TemporaryDirectory* folder_ = nullptr;
  static inline std::filesystem::path model_path_;
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
