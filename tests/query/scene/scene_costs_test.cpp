// What queries of scenes cost besides processor time, while every instance moves.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "planetree/scene_shell.h"
#include "query/scene/scene_state.h"
#include "tests/cache/allocation_count.h"
#include "tests/query/call_trap.h"
#include "tests/query/eventually.h"
#include "tests/query/lock_count.h"
#include "tests/query/scene/scene_fixture.h"
#include "tests/query/shell/shells.h"

namespace planetree::query {
namespace {

using SceneCosts = SceneFixture;

constexpr QueryOptions kNow{.wait = Wait::kNever};

struct Ticks {
  std::uint64_t allocations = 0, locks = 0, calls = 0, degraded = 0;
};

// Moves all instances and asks, over and over.
void run_ticks(Scene& scene, SceneProbe& probe, const PointShell& shell, SceneShellState& state,
               const std::vector<InstanceId>& ids, int ticks, std::uint64_t& degraded) {
  for (int tick = 0; tick < ticks; ++tick) {
    const double turn = 0.001 * (tick % 500);
    for (std::size_t i = 0; i < ids.size(); ++i)
      (void)scene.set_pose(ids[i], {{std::sqrt(1 - turn * turn), 0, turn, 0},
                                    {2.5 * static_cast<double>(i) + turn, 0, 0}});
    const Vec3 tool{0.07 * (tick % 300), 0.4, 1.05};
    degraded += probe.closest_point(tool, kNow).status == Status::kDegraded;
    probe.contains({tool.x, 0.2, 0.3}, kNow);
    std::array<SceneClosestPoint, 8> found;
    probe.contacts(tool, 0.2, found, kNow);
    probe.first_contact({tool, {tool.x + 0.1, 0.3, 0.9}, 0.05}, 0.001, kNow);
    probe.first_hit({tool, {0.1, -0.2, -1}}, kNow);
    (void)shell.wrench(probe, state, {{}, tool}, {.wait = Wait::kNever, .max_work = 500});
    probe.motion(tool, {70, 0, 0});
  }
}

TEST_F(SceneCosts, AllocateLockAndCallNothing) {
  if (!cache::allocations_are_counted() || !locks_are_counted())
    GTEST_SKIP() << "a sanitizer counts instead";
  SceneOptions options = small_options();
  options.memory_budget_bytes = std::uint64_t{720} << 10;  // for some of the pages
  Scene scene = make_scene(options);
  std::vector<InstanceId> ids;
  for (int i = 0; i < 8; ++i) ids.push_back(add(scene, i % 2 ? ball_ : fine_ball_));
  SceneProbe probe = make_probe(scene);
  const PointShell shell = std::move(*PointShell::create(ball_shell(100, 0.2)));
  SceneShellState state = std::move(*SceneShellState::create(shell, 2));
  Ticks counts;
  bool is_trapped = false;
  std::uint64_t warm = 0;
  std::thread thread([&] {
    run_ticks(scene, probe, shell, state, ids, 200, warm);
    counts.allocations = cache::allocation_count();
    counts.locks = lock_count();
    is_trapped = set_call_trap();
    counts.calls = trapped_calls();
    run_ticks(scene, probe, shell, state, ids, 3000, counts.degraded);
    counts.calls = trapped_calls() - counts.calls;
    counts.locks = lock_count() - counts.locks;
    counts.allocations = cache::allocation_count() - counts.allocations;
  });
  thread.join();
  EXPECT_TRUE(is_trapped);
  EXPECT_EQ(counts.allocations, 0u);
  EXPECT_EQ(counts.locks, 0u);
  EXPECT_EQ(counts.calls, 0u);
  EXPECT_GT(counts.degraded, 0u) << "no page was ever missing";
  EXPECT_LT(counts.degraded, 3000u);
}

TEST_F(SceneCosts, RemovingWaitsForTheQueriesThatRun) {
  const auto state = SceneState::create(small_options());
  ASSERT_TRUE(state);
  SceneState& scene = **state;
  const auto ball = scene.add(ball_.path(), {}, kAllLayers);
  ASSERT_TRUE(ball);
  scene.sections().enter(1);
  std::atomic<bool> is_removed{false};
  std::thread remover([&] {
    EXPECT_TRUE(scene.remove(*ball));
    is_removed = true;
  });
  EXPECT_TRUE(eventually([&] { return !scene.info(*ball); })) << "queries still find it";
  for (int i = 0; i < 100 && !is_removed; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_FALSE(is_removed);
  scene.sections().leave(1);
  remover.join();
  EXPECT_TRUE(is_removed);
}

// Two threads ask while one moves an instance and another adds and removes others.
TEST_F(SceneCosts, ThreadsSeeEachInstanceSomewhereOnItsWay) {
  Scene scene = make_scene();
  const InstanceId ball = add(scene, ball_, at(0));
  std::atomic<bool> stop{false};
  std::atomic<std::uint64_t> queries{0};
  const auto ask = [&](Wait wait) {
    SceneProbe probe = make_probe(scene);
    while (!stop) {
      // The ball's centre is between x = 0 and 1; others are at least 6 away.
      const SceneClosestPoint answer = probe.closest_point({0.5, 0, 2}, {.wait = wait});
      ASSERT_LE(answer.lower, std::hypot(0.5, 0.3, 2.2) - 0.99);
      ASSERT_GE(answer.upper, 0.99);
      if (answer.status == Status::kExact) {
        ASSERT_EQ(answer.instance, ball);
      }
      ++queries;
    }
  };
  std::thread one(ask, Wait::kForPages), two(ask, Wait::kNever);
  std::thread mover([&] {
    for (int i = 0; !stop; ++i) {
      ASSERT_TRUE(scene.set_pose(ball, turned(0.01 * (i % 100), 0.005 * (i % 100))));
    }
  });
  for (int i = 0; i < 100 || queries < 2000; ++i) {
    const InstanceId added = add(scene, i % 2 ? ball_ : fine_ball_, at(10 + i % 7));
    ASSERT_TRUE(scene.remove(added));
  }
  stop = true;
  one.join();
  two.join();
  mover.join();
}

}  // namespace
}  // namespace planetree::query
