#pragma once

#include <gtest/gtest.h>

#include <cerrno>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/octree/builder/build_fixture.h"
#include "tests/storage/system/faulty_calls.h"

namespace planetree::octree {

/// Records what a build reports.
class BuildRecorder final : public BuildProgress {
 public:
  struct Count {
    std::uint64_t resumed = 0, done = 0, total = 0;
  };

  Result<void> progress(BuildPhase phase, std::uint64_t done, std::uint64_t total) override {
    const auto [at, begun] = counts_.try_emplace(phase, Count{done, done, total});
    EXPECT_GE(done, at->second.done);
    EXPECT_LE(done, total);
    at->second.done = done;
    return {};
  }
  void resumes(const std::string& what) override { start = what; }
  void failed_at(BuildDirectory index, const std::filesystem::path& path) override {
    failed = {index, path};
  }

  bool did(BuildPhase phase) const { return counts_.contains(phase); }
  Count count(BuildPhase phase) const { return did(phase) ? counts_.at(phase) : Count{}; }

  std::string start;
  std::optional<std::pair<BuildDirectory, std::filesystem::path>> failed;

 private:
  std::map<BuildPhase, Count> counts_;
};

/// Builds that are stopped and resumed.
class ResumedBuild : public SmallChunks {
 protected:
  using Fault = storage::FaultyCalls::Fault;
  using Names = std::vector<std::string>;

  Result<BuildReport> build() {
    storage::FaultyCalls calls;  // do not fail, and do not wait for the disk
    return build(calls);
  }
  Result<BuildReport> build(storage::FileCalls& calls, const BuildMemory& memory = kTight) {
    recorder_ = {};
    return build_tree(input(), output_, options_, recorder_, {40, 60, memory, calls});
  }
  // The bytes that a build without interruption writes.
  storage::Bytes whole() {
    options_.resume = false;
    EXPECT_TRUE(build());
    options_.resume = true;
    storage::Bytes bytes = built();
    std::filesystem::remove(output_);
    return bytes;
  }
  // Lets every system call from `call` on fail. False if the build makes fewer calls.
  bool stop_at(int call) {
    storage::FaultyCalls calls;
    calls.fault = Fault::kError;
    calls.number = ENOSPC;
    calls.fault_at = call;
    calls.every = true;
    const auto stopped = build(calls);
    EXPECT_TRUE(stopped || calls.happened());
    return calls.happened();
  }
  // Stops builds, each from the start, until one has completed `parts` parts of `phase`.
  void stop_in(BuildPhase phase, std::uint64_t parts = 0) {
    recorder_ = {};
    for (int call = 0; !recorder_.did(phase) || recorder_.count(phase).done < parts; call += 9) {
      std::filesystem::remove_all(work_);
      ASSERT_TRUE(stop_at(call));
    }
    ASSERT_FALSE(std::filesystem::exists(output_));
    ASSERT_TRUE(std::filesystem::exists(work_));
  }
  void expect_completed(const storage::Bytes& expected) {
    const auto report = build();
    ASSERT_TRUE(report) << report.error().text;
    ASSERT_EQ(built(), expected);
    ASSERT_EQ(folder_.names(), Names{"model.ptree"});
  }

  /// Completes the stopped build and removes its output. False if it was complete before.
  bool resume_and_remove(const storage::Bytes& expected) {
    const bool complete = std::filesystem::exists(output_);
    expect_completed(expected);
    std::filesystem::remove(output_);
    return !complete;
  }

  static BuildOptions resumable() {
    BuildOptions options;
    options.page_bytes = 4096;
    options.resume = true;
    options.replace = true;
    return options;
  }
  static Soup holed() {
    Soup soup = sphere(2);
    soup.resize(soup.size() - 5);
    return soup;
  }

  BuildOptions options_ = resumable();
  std::filesystem::path work_ = folder_ / "model.ptree.work";
  BuildRecorder recorder_;
};

}  // namespace planetree::octree
