// Progress, the end of a build by its caller, and going on with it.

#include <atomic>
#include <optional>
#include <stdexcept>
#include <thread>

#include "tests/public_api/meshes.h"

namespace planetree::public_api {
namespace {

class BuildControl : public InFolder {
 protected:
  Mesh mesh_ = torus(60, 50);
  BuildOptions options_ = small_options();
};

TEST_F(BuildControl, ReportsPhasesInOrderAndToTheirEnds) {
  std::vector<BuildPhase> phases;
  std::uint64_t last_done = 0, last_total = 0;
  options_.on_progress = [&](BuildPhase phase, std::uint64_t done, std::uint64_t total) {
    EXPECT_LE(done, total);
    if (phases.empty() || phase != phases.back()) {
      EXPECT_EQ(last_done, last_total);
      phases.push_back(phase);
    } else {
      EXPECT_GE(done, last_done);
    }
    last_done = done, last_total = total;
    return true;
  };
  ASSERT_TRUE(build(mesh_.input(), output(), options_));
  EXPECT_EQ(last_done, last_total);
  EXPECT_EQ(phases, (std::vector{BuildPhase::kReading, BuildPhase::kOrdering, BuildPhase::kMatching,
                                 BuildPhase::kBuildingTree, BuildPhase::kBuildingMask,
                                 BuildPhase::kBuildingField, BuildPhase::kWriting}));
}

// Cancels at the first report of progress, then at the second, and so on.
TEST_F(BuildControl, CancelsAtAnyReportAndLeavesNothing) {
  int cancelled = 0;
  for (bool is_built = false; !is_built; ++cancelled) {
    int calls = 0;
    options_.on_progress = [&](BuildPhase, std::uint64_t, std::uint64_t) {
      return calls++ != cancelled;
    };
    const auto report = build(mesh_.input(), output(), options_);
    is_built = static_cast<bool>(report);
    if (is_built) break;
    EXPECT_EQ(report.error().code, ErrorCode::kCancelled) << report.error().text;
    EXPECT_EQ(calls, cancelled + 1) << "a call after the one that cancelled";
    EXPECT_TRUE(is_empty()) << cancelled;
  }
  EXPECT_GE(cancelled, 10);
}

TEST_F(BuildControl, CancelsByAFlag) {
  std::atomic<bool> cancel = true;
  options_.cancel = &cancel;
  const auto report = build(mesh_.input(), output(), options_);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kCancelled);
  EXPECT_TRUE(is_empty());
  cancel = false;
  EXPECT_TRUE(build(mesh_.input(), output(), options_));
}

// The callback never ends the triangles by itself.
TEST_F(BuildControl, CancelsEndlessReadingFromAnotherThread) {
  std::atomic<bool> cancel = false, has_begun = false;
  options_.cancel = &cancel;
  const BuildInput endless([&](std::span<TriangleCorners> buffer) -> Result<std::size_t> {
    buffer.front() = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}};
    std::fill(buffer.begin() + 1, buffer.end(), buffer.front());
    has_begun = true;
    return buffer.size();
  });
  std::thread other([&] {
    while (!has_begun) std::this_thread::yield();
    cancel = true;
  });
  const auto report = build(endless, output(), options_);
  other.join();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kCancelled);
  EXPECT_TRUE(is_empty());
}

TEST_F(BuildControl, LeavesAnExistingFileAsItWas) {
  std::ofstream(output()) << "precious";
  options_.on_progress = [](BuildPhase phase, std::uint64_t done, std::uint64_t total) {
    return phase != BuildPhase::kWriting || done != total;
  };
  EXPECT_FALSE(build(mesh_.input(), output(), options_));
  EXPECT_EQ(bytes_of(output()), "precious");
}

TEST_F(BuildControl, ReturnsTheErrorOfTheCallback) {
  const BuildInput input([](std::span<TriangleCorners>) -> Result<std::size_t> {
    return make_error(ErrorCode::kReadFailed, Error::kNowhere, Error::kNowhere, "the tape broke");
  });
  const auto report = build(input, output(), options_);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kReadFailed);
  EXPECT_STREQ(report.error().text, "the tape broke");
}

TEST_F(BuildControl, ExceptionsOfCallbacksBecomeErrors) {
  const BuildInput input(
      [](std::span<TriangleCorners>) -> Result<std::size_t> { throw std::runtime_error("broke"); });
  const auto of_source = build(input, output(), options_);
  ASSERT_FALSE(of_source);
  EXPECT_EQ(of_source.error().code, ErrorCode::kBadInput);
  EXPECT_NE(std::string(of_source.error().text).find("broke"), std::string::npos);

  options_.on_failure = [](const std::filesystem::path&) { throw 1; };
  options_.on_progress = [](BuildPhase, std::uint64_t, std::uint64_t) -> bool { throw 2; };
  const auto of_progress = build(mesh_.input(), output(), options_);
  ASSERT_FALSE(of_progress);
  EXPECT_EQ(of_progress.error().code, ErrorCode::kBadInput);
  EXPECT_TRUE(is_empty());
}

TEST_F(BuildControl, RefusesMoreTrianglesThanTheBufferHolds) {
  const BuildInput input(
      [](std::span<TriangleCorners> buffer) -> Result<std::size_t> { return buffer.size() + 1; });
  const auto report = build(input, output(), options_);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadInput);
}

TEST_F(BuildControl, ResumesAMeshInMemoryWhereItWasCancelled) {
  const std::string whole = built(mesh_.input());
  std::filesystem::remove(output());
  options_.resume = true;
  std::string line;
  options_.on_resume = [&line](const std::string& text) { line = text; };
  options_.on_progress = [](BuildPhase phase, std::uint64_t, std::uint64_t) {
    return phase != BuildPhase::kBuildingMask;
  };
  const auto cancelled = build(mesh_.input(), output(), options_);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
  EXPECT_FALSE(is_empty()) << "the checkpoint";

  bool has_read = false;
  options_.on_progress = [&has_read](BuildPhase phase, std::uint64_t, std::uint64_t) {
    has_read = has_read || phase == BuildPhase::kReading;
    return true;
  };
  EXPECT_EQ(built(mesh_.input(), options_), whole);
  EXPECT_FALSE(has_read) << line;
  EXPECT_FALSE(line.empty());
  std::filesystem::remove(output());
  EXPECT_TRUE(is_empty());
}

TEST_F(BuildControl, ResumesNoOtherMesh) {
  options_.resume = true;
  options_.on_progress = [](BuildPhase phase, std::uint64_t, std::uint64_t) {
    return phase != BuildPhase::kBuildingMask;
  };
  ASSERT_FALSE(build(mesh_.input(), output(), options_));
  mesh_.vertices[7].z += 0.25;
  const std::string whole = built(mesh_.input());
  std::filesystem::remove(output());
  options_.on_progress = nullptr;
  EXPECT_EQ(built(mesh_.input(), options_), whole);
}

TEST_F(BuildControl, DoesNotResumeCallbacks) {
  options_.resume = true;
  const auto report = build(mesh_.stream(9), output(), options_);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadArgument);
  EXPECT_TRUE(is_empty());
}

}  // namespace
}  // namespace planetree::public_api
