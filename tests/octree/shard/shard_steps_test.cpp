// Steps that are repeated, stopped, or run with results of other steps.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <random>
#include <string>

#include "tests/octree/shard/sharded_build.h"

namespace planetree::octree {
namespace {

class ShardSteps : public ShardedBuild {
 protected:
  using Fault = storage::FaultyCalls::Fault;

  void SetUp() override {
    Soup soup = sphere(2);
    soup.resize(soup.size() - 5);
    write(soup);
    expected_ = whole();
  }
  template <class Value>
  void expect_text(const Result<Value>& refused, ErrorCode code, const std::string& part) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, code) << refused.error().text;
    EXPECT_NE(std::string(refused.error().text).find(part), std::string::npos)
        << refused.error().text;
  }
  void touch_mesh() const { storage::write_bytes(mesh_, storage::read_bytes(mesh_)); }

  storage::Bytes expected_;
};

TEST_F(ShardSteps, DoNothingTheSecondTime) {
  run_all(3);
  const auto again = plan(3);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->was_done);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const auto bytes = storage::read_bytes(file_of(ShardKind::kSorted, i));
    const auto mapped = map(i), reduced = reduce(i);
    ASSERT_TRUE(mapped && reduced);
    EXPECT_TRUE(mapped->was_done && reduced->was_done);
    EXPECT_FALSE(recorder_.did(BuildPhase::kReading) || recorder_.did(BuildPhase::kBuildingTree));
    EXPECT_EQ(storage::read_bytes(file_of(ShardKind::kSorted, i)), bytes);
  }
  ASSERT_TRUE(merge());
  EXPECT_EQ(built(), expected_);
}

TEST_F(ShardSteps, SayWhichStepIsMissing) {
  expect_text(map(0), ErrorCode::kNotFound, "planetree shard plan MESH -o JOB");
  expect_text(merge(), ErrorCode::kNotFound, "planetree shard plan MESH -o JOB");
  ASSERT_TRUE(plan(2));
  ASSERT_TRUE(map(0));
  expect_text(reduce(0), ErrorCode::kNotFound, "'planetree shard map JOB 1'");
  ASSERT_TRUE(map(1));
  ASSERT_TRUE(reduce(0));
  expect_text(merge(), ErrorCode::kNotFound, "'planetree shard reduce JOB 1'");
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(ShardSteps, RefuseANumberThatThePlanDoesNotHave) {
  ASSERT_TRUE(plan(2));
  expect_text(map(2), ErrorCode::kBadArgument, "the plan has 2, from 0 to 1");
  expect_text(reduce(2), ErrorCode::kBadArgument, "the plan has 2, from 0 to 1");
}

TEST_F(ShardSteps, RefuseAMeshThatChanged) {
  ASSERT_TRUE(plan(2));
  Soup soup = sphere(2);
  soup.resize(soup.size() - 5);
  soup[50][0].x *= 0.5;
  write(soup);
  expect_text(map(0), ErrorCode::kBadInput, "the input has changed since");
  EXPECT_EQ(recorder_.failed->second, mesh_);
  EXPECT_FALSE(std::filesystem::exists(file_of(ShardKind::kSorted, 0)));
}

TEST_F(ShardSteps, TakeACopyOfTheMesh) {
  ASSERT_TRUE(plan(2));
  touch_mesh();
  run_all_after_plan(2);
  EXPECT_EQ(built(), expected_);
}

TEST_F(ShardSteps, RefuseResultsOfAnotherPlan) {
  run_all(2);
  options_.page_bytes = 8192;
  ASSERT_TRUE(plan(2));
  expect_text(reduce(0), ErrorCode::kBadInput, "'planetree shard map JOB 0' again");
  expect_text(merge(), ErrorCode::kBadInput, "'planetree shard map JOB 0' again");
  const auto again = map(0);
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->was_done);
  expect_text(reduce(0), ErrorCode::kBadInput, "'planetree shard map JOB 1' again");
  ASSERT_TRUE(map(1));
  expect_text(merge(), ErrorCode::kBadInput, "'planetree shard reduce JOB 0' again");
  const storage::Bytes expected = whole();
  run_all_after_plan(2);
  EXPECT_EQ(built(), expected);
}

TEST_F(ShardSteps, RefuseResultsOfOtherParts) {
  run_all(2);
  // A part of the same plan under the name of another.
  std::filesystem::copy_file(file_of(ShardKind::kSorted, 1), file_of(ShardKind::kSorted, 0),
                             std::filesystem::copy_options::overwrite_existing);
  expect_text(reduce(0), ErrorCode::kBadInput, "'planetree shard map JOB 0' again");
  expect_text(merge(), ErrorCode::kBadInput, "'planetree shard map JOB 0' again");
}

// Every step, killed before any of its system calls and run again.
TEST_F(ShardSteps, CanBeKilledAtAnyCall) {
  std::mt19937 random(3);
  int kills = 0;
  for (int round = 0; round < 3; ++round) {
    std::filesystem::remove_all(job_);
    const auto killed = [&](const auto& step, int call) {
      const pid_t child = ::fork();
      if (child == 0) {
        storage::FaultyCalls calls;
        calls.fault = Fault::kKill;
        calls.fault_at = call;
        ::_exit(step(calls) ? 0 : 1);
      }
      int status = 0;
      ::waitpid(child, &status, 0);
      EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
      return WIFSIGNALED(status);
    };
    const auto until_done = [&](const auto& step) {
      for (int call = static_cast<int>(random() % 4); killed(step, call);
           call += 1 + static_cast<int>(random() % 9))
        ++kills;
      const auto done = step(idle_);
      EXPECT_TRUE(done) << done.error().text;
    };
    until_done([&](auto& calls) { return plan(3, calls); });
    for (std::uint32_t i = 0; i < 3; ++i) until_done([&](auto& calls) { return map(i, calls); });
    for (std::uint32_t i = 0; i < 3; ++i) until_done([&](auto& calls) { return reduce(i, calls); });
    until_done([&](auto& calls) { return merge(calls); });
    EXPECT_EQ(built(), expected_);
  }
  EXPECT_GE(kills, 50);
}

TEST_F(ShardSteps, ReportErrorsOfTheSystem) {
  const auto fails_cleanly = [&](const auto& step) {
    for (int call = 0;; call += 3) {
      storage::FaultyCalls calls;
      calls.fault = Fault::kError;
      calls.number = ENOSPC;
      calls.fault_at = call;
      calls.every = true;
      const auto done = step(calls);
      if (!calls.happened()) return;
      ASSERT_FALSE(done && !calls.happened());
    }
  };
  fails_cleanly([&](auto& calls) { return plan(2, calls); });
  for (std::uint32_t i = 0; i < 2; ++i) fails_cleanly([&](auto& calls) { return map(i, calls); });
  for (std::uint32_t i = 0; i < 2; ++i)
    fails_cleanly([&](auto& calls) { return reduce(i, calls); });
  fails_cleanly([&](auto& calls) { return merge(calls); });
  EXPECT_EQ(built(), expected_);
}

// A changed byte of any file of the job is found where it is read, and the step repairs it.
TEST_F(ShardSteps, FindChangedBytes) {
  run_all(2);
  std::mt19937 random(5);
  for (const ShardKind kind : {ShardKind::kSorted, ShardKind::kBuilt})
    for (std::uint32_t shard = 0; shard < 2; ++shard) {
      const auto path = file_of(kind, shard);
      const auto bytes = storage::read_bytes(path);
      for (int i = 0; i < 40; ++i) {
        auto changed = bytes;
        changed[random() % changed.size()] ^= static_cast<std::byte>(1 + random() % 255);
        storage::write_bytes(path, changed);
        const auto merged = merge();
        if (merged) {
          EXPECT_EQ(built(), expected_);  // no step reads the byte again
          continue;
        }
        const ErrorCode code = merged.error().code;
        EXPECT_TRUE(code == ErrorCode::kDamaged || code == ErrorCode::kBadInput ||
                    code == ErrorCode::kTruncated)
            << merged.error().text;
      }
      storage::write_bytes(path, bytes);
    }
  ASSERT_TRUE(merge());
  EXPECT_EQ(built(), expected_);
  const auto path = file_of(ShardKind::kSorted, 1);
  storage::write_bytes(path, storage::Bytes(100));
  const auto repaired = map(1);
  ASSERT_TRUE(repaired) << repaired.error().text;
  EXPECT_FALSE(repaired->was_done);
}

}  // namespace
}  // namespace planetree::octree
