#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <thread>
#include <utility>
#include <vector>

#include "octree/geometry/rigid_transform.h"
#include "planetree/point_shell.h"
#include "tests/cache/allocation_count.h"
#include "tests/query/call_trap.h"
#include "tests/query/eventually.h"
#include "tests/query/fetch_steps.h"
#include "tests/query/lock_count.h"
#include "tests/query/sample_model.h"
#include "tests/query/shell/shells.h"

namespace planetree::query {
namespace {

double distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

// A ball of 400 points and radius 0.3 beside a sphere of 8,192 triangles and radius 1.
class ShellRealTime : public testing::Test {
 protected:
  // In contact in many places, from 0 to 1 around the sphere.
  static Pose around(double share) {
    const double turn = 6.25 * share, depth = 1.27 - 0.05 * share;
    return {turned_by(turn), {depth * std::cos(turn), depth * std::sin(turn), 0.1}};
  }
  void expect_holds(const Wrench& found, const Wrench& exact) {
    EXPECT_LE(distance(found.force, exact.force), found.force_error + exact.force_error);
    EXPECT_LE(distance(found.torque, exact.torque), found.torque_error + exact.torque_error);
  }
  Wrench exact(const Pose& pose, ShellOptions options) {
    options.wait = Wait::kForPages;
    options.max_work = QueryOptions::kNoLimit;
    const Wrench found = shell_.wrench(exact_probe_, exact_state_, pose, options);
    EXPECT_EQ(found.status, Status::kExact);
    return found;
  }

  // For tests that take the steps of the fetch thread: what is missing does not depend on its
  // speed.
  Model open_without_threads(std::uint64_t budget_bytes) const {
    OpenOptions options;
    options.max_probes = 2;  // one of them for the worker
    options.memory_budget_bytes = budget_bytes;
    auto model = ModelState::open_model(sample_.path(), options, {.starts_fetching = false});
    EXPECT_TRUE(model);
    return *std::move(model);
  }

  const std::atomic<bool> never_{false};
  const SampleModel sample_ = SampleModel::masked(octree::sphere(5));
  const PointShell shell_ = std::move(*PointShell::create(ball_shell(400, 0.3)));
  const ShellOptions options_{.margin = 0.005, .max_depth = 0.2, .wait = Wait::kNever};

 private:
  const Model exact_model_ = sample_.open();
  Probe exact_probe_ = make_probe(exact_model_);
  PointShellState exact_state_ = std::move(*PointShellState::create(shell_, exact_model_));
};

TEST_F(ShellRealTime, HoldsInLittleMemory) {
  const Model model = open_without_threads(sample_.min_budget(2) + 8 * 4096);
  FetchWorker worker = fetch_worker(ModelState::of(model), &still_time, never_);
  Probe probe = make_probe(model);
  PointShellState state = *PointShellState::create(shell_, model);
  std::size_t degraded = 0;
  for (int i = 0; i < 400; ++i) {
    const Pose pose = around(i / 400.0);
    const Wrench found = shell_.wrench(probe, state, pose, options_);
    const Wrench expected = exact(pose, options_);
    expect_holds(found, expected);
    degraded += found.status == Status::kDegraded;
    EXPECT_TRUE(std::isfinite(found.force_error));
    if (found.status == Status::kExact) {
      EXPECT_EQ(bits_of(found), bits_of(expected));
    }
    // Pages come late: one request is served in two ticks.
    if (i % 2 == 1) (void)worker.work();
  }
  EXPECT_GT(degraded, 10u);
  EXPECT_LT(degraded, 390u);
  EXPECT_GT(model.stats().pages_evicted, 0u);
}

TEST_F(ShellRealTime, RequestsThePagesThatItLacks) {
  const Model model = open_without_threads(std::uint64_t{64} << 20);
  FetchWorker worker = fetch_worker(ModelState::of(model), &still_time, never_);
  Probe probe = make_probe(model);
  PointShellState state = *PointShellState::create(shell_, model);
  const std::uint64_t read_before = model.stats().pages_read;
  Wrench found = shell_.wrench(probe, state, around(0.5), options_);
  EXPECT_EQ(found.status, Status::kDegraded);
  EXPECT_GT(found.undecided, 0u);
  EXPECT_EQ(model.stats().pages_read, read_before);
  EXPECT_TRUE(eventually([&] {
    (void)worker.work();
    found = shell_.wrench(probe, state, around(0.5), options_);
    return found.status == Status::kExact;
  }));
  EXPECT_GT(model.stats().pages_read, read_before);
  EXPECT_EQ(bits_of(found), bits_of(exact(around(0.5), options_)));
}

TEST_F(ShellRealTime, HoldsWithinAnyWork) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  PointShellState state = *PointShellState::create(shell_, model);
  for (const Wait wait : {Wait::kForPages, Wait::kNever}) {
    for (const std::uint32_t work : {0U, 1U, 2U, 7U, 30U, 200U, 5000U}) {
      ShellOptions options = options_;
      options.wait = wait;
      options.max_work = work;
      state.reset();
      for (int i = 0; i < 40; ++i) {
        const Pose pose = around(0.3 + i / 4000.0);
        const Wrench found = shell_.wrench(probe, state, pose, options);
        expect_holds(found, exact(pose, options));
        EXPECT_LE(found.work, work);
        EXPECT_LE(found.queries, work + 1);
        EXPECT_TRUE(std::isfinite(found.force_error));
      }
    }
  }
}

TEST_F(ShellRealTime, MoreWorkMakesErrorsSmaller) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  PointShellState state = *PointShellState::create(shell_, model);
  ShellOptions options = options_;
  options.wait = Wait::kForPages;
  double widest = 0, last = 0;
  for (const std::uint32_t work : {0U, 100U, 400U, 10000U}) {
    state.reset();
    options.max_work = work;
    last = shell_.wrench(probe, state, around(0.5), options).force_error;
    if (work == 0) widest = last;
    EXPECT_LE(last, widest) << work;
    widest = last;
  }
  EXPECT_LT(last, 1e-10);
}

// Each call has work for ten queries or less. What it queries comes last in the next calls.
TEST_F(ShellRealTime, LittleWorkKeepsUpWithSlowMotion) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  PointShellState state = *PointShellState::create(shell_, model);
  ShellOptions options = options_;
  options.wait = Wait::kForPages;
  const Wrench expected = exact(around(0.5), options);
  state.reset();
  options.max_work = 60;
  double first = 0, last = 0;
  for (int i = 0; i < 60; ++i) {
    const Wrench found = shell_.wrench(probe, state, around(0.5 + i * 1e-7), options);
    EXPECT_EQ(found.status, Status::kDegraded);
    last = found.force_error;
    if (i == 0) first = last;
  }
  EXPECT_GT(expected.contacts, 20u);
  EXPECT_GT(first, 0.1);
  EXPECT_LT(last, 1e-3);
}

// The errors cover the intervals of all contacts, whose errors may all point in one direction.
TEST_F(ShellRealTime, ErrorsAreNoLessThanThoseOfTheContacts) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  ShellOptions options = options_;
  options.stiffness = 2;
  options.reference = {0.2, -0.1, 0};
  options.wait = Wait::kForPages;
  std::vector<ShellContact> contacts(shell_.size());
  for (const ForceDirection direction : {ForceDirection::kToolNormal, ForceDirection::kModelNormal})
    for (const std::uint32_t work : {0U, 20U, 200U, 500U}) {
      options.force_direction = direction;
      options.max_work = work;
      PointShellState state = *PointShellState::create(shell_, model);
      std::ranges::fill(contacts, ShellContact{});
      const Pose pose = around(0.5);
      const Vec3 about = octree::RigidTransform::of(pose)->apply(options.reference);
      const Wrench found = shell_.wrench(probe, state, pose, options, contacts);
      double force = 0, torque = 0;
      for (const ShellContact& contact : contacts) {
        const bool is_known =
            direction == ForceDirection::kToolNormal || contact.status == Status::kExact;
        const double off = is_known ? std::max(contact.depth_upper - contact.depth,
                                               contact.depth - contact.depth_lower)
                                    : contact.depth_upper + contact.depth;
        const Vec3 arm{contact.position.x - about.x, contact.position.y - about.y,
                       contact.position.z - about.z};
        const Vec3& d = contact.direction;
        const Vec3 moment{arm.y * d.z - arm.z * d.y, arm.z * d.x - arm.x * d.z,
                          arm.x * d.y - arm.y * d.x};
        force += options.stiffness * off;
        torque += options.stiffness * off * (is_known ? distance(moment, {}) : distance(arm, {}));
      }
      EXPECT_GT(found.force_error, 0);
      EXPECT_GE(found.force_error * (1 + 1e-12), force);
      EXPECT_GE(found.torque_error * (1 + 1e-12), torque);
    }
}

TEST_F(ShellRealTime, AllocatesLocksAndCallsNothing) {
  if (!cache::allocations_are_counted() || !locks_are_counted())
    GTEST_SKIP() << "a sanitizer counts instead";
  const Model model = sample_.open(sample_.min_budget() + 8 * 4096);
  Probe probe = make_probe(model);
  PointShellState state = *PointShellState::create(shell_, model);
  std::vector<ShellContact> contacts(shell_.size());
  std::uint64_t allocations = 0, locks = 0, calls = 0, in_contact = 0;
  std::thread([&] {
    const std::uint64_t allocated = cache::allocation_count(), locked = lock_count();
    const bool are_trapped = set_call_trap();
    const std::uint64_t trapped = trapped_calls();
    for (int i = 0; i < 600; ++i) {
      ShellOptions options = options_;
      if (i % 3 == 0) options.depth_rule = DepthRule::kTwoSided;
      if (i % 5 == 0) options.force_direction = ForceDirection::kModelNormal;
      in_contact += shell_.wrench(probe, state, around(i / 600.0), options, contacts).contacts;
    }
    if (are_trapped) calls = trapped_calls() - trapped;
    locks = lock_count() - locked;
    allocations = cache::allocation_count() - allocated;
  }).join();
  EXPECT_EQ(allocations, 0u);
  EXPECT_EQ(locks, 0u);
  EXPECT_EQ(calls, 0u);
  EXPECT_GT(in_contact, 1000u);
}

}  // namespace
}  // namespace planetree::query
