// Recommendations of `planetree tune`, tried in sessions of other seeds.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "planetree/planetree.h"
#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/cli/captured_console.h"
#include "tools/cli/policy_option.h"
#include "tools/session/session_path.h"
#include "tools/session/session_trace.h"
#include "tools/simulation/simulated_session.h"
#include "tools/trace_file/trace_writer.h"
#include "tools/tune/session_sample.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::json;

class Recommendation : public testing::Test {
 protected:
  static constexpr int kSeeds = 20;

  static void SetUpTestSuite() {
    folder_ = new storage::TemporaryDirectory;
    model_ = (*folder_ / "statue.ptree").string();
    const std::string mesh = (*folder_ / "statue.ply").string();
    ASSERT_EQ(run({"generate", mesh, "--triangles", "30K", "--quiet"}).status, 0);
    ASSERT_EQ(run({"build", mesh, "-o", model_, "--page-size", "4K", "--quiet"}).status, 0);
    for (const char* seed : {"101", "102", "103"}) {
      traces_.push_back((*folder_ / ".").string() + seed + ".trace");
      const Outcome recorded =
          run({"touch", model_, "--deterministic", "--seconds", "2", "--path", "scratch", "--seed",
               seed, "--memory", "16M", "--trace", traces_.back()});
      ASSERT_EQ(recorded.status, 0) << recorded.errors;
    }
  }
  static void TearDownTestSuite() { delete folder_; }

  static Json recommended(const std::string& goal, const std::vector<std::string>& traces) {
    std::vector<std::string> command = {"tune", "--json", "--recommend", goal};
    command.insert(command.end(), traces.begin(), traces.end());
    const Outcome result = run(command);
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output)["recommended"];
  }

  /// What a session of another seed comes to; nothing if the model cannot be opened.
  static std::optional<FeltFigures> session(std::uint64_t seed, std::uint64_t bytes,
                                            const Json& best) {
    SimulationOptions options;
    options.file = model_;
    options.memory_bytes = bytes;
    options.policy = policy_of(best);
    auto session = SimulatedSession::open(options);
    if (!session) return std::nullopt;
    const auto model = Model::open(model_);
    auto probe = Probe::create(*model);
    std::vector<FeltTick> ticks;
    for (const Tick& tick :
         (*session)->run(touch_path(*model, *probe, TouchMotion::kScratch, 2000, seed)).ticks)
      ticks.push_back({tick.status == Status::kDegraded, tick.width, 0});
    return figures_of(ticks);
  }

  static EvictionPolicy policy_of(const Json& best) {
    for (const EvictionPolicy policy : kAllPolicies)
      if (best["policy"] == name_of(policy)) return policy;
    ADD_FAILURE() << best;
    return EvictionPolicy::kClock;
  }

  /// Tries a recommendation, and four fifths of its memory, in sessions of other seeds.
  template <class Keeps>
  static void expect_kept(const Json& best, const Keeps& keeps) {
    ASSERT_EQ(best["kept"], true) << best;
    const std::uint64_t bytes = best["memory_bytes"];
    int kept = 0, kept_with_less = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      kept += keeps(seed, bytes);
      kept_with_less += keeps(seed, bytes * 8 / 10);
    }
    EXPECT_GE(kept, 19) << best;
    EXPECT_LE(kept_with_less, 5) << best;
  }

  /// Pages read a blocking query of points in the model's box.
  ///
  /// trace  file to write; empty: none
  static double misses(std::uint64_t seed, OpenOptions options, const std::string& trace = "") {
    options.max_probes = 1;
    constexpr int kQueries = 2000;
    const auto model = Model::open(model_, options);
    EXPECT_TRUE(model);
    auto probe = Probe::create(*model);
    const Vec3 lower = model->info().box_lower, upper = model->info().box_upper;
    const std::uint64_t before = model->stats().pages_read;
    std::mt19937_64 random(seed);
    const auto between = [&](double from, double to) {
      return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    for (int i = 0; i < kQueries; ++i) {
      const double x = between(lower.x, upper.x), y = between(lower.y, upper.y);
      (void)probe->closest_point({x, y, between(lower.z, upper.z)});
    }
    if (!trace.empty()) write_trace(*model, options, trace);
    return static_cast<double>(model->stats().pages_read - before) / kQueries;
  }

  static void write_trace(const Model& model, const OpenOptions& options,
                          const std::string& trace) {
    auto writer = TraceWriter::create(trace, false);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(
        writer->begin(trace_header_of(model, model_, options.memory_budget_bytes, options.policy)));
    std::vector<PageAccess> accesses(1 << 20);
    const std::size_t count = model.drain_page_trace(accesses);
    ASSERT_LT(count, accesses.size());
    ASSERT_TRUE(writer->add(std::span(accesses).first(count)));
    ASSERT_TRUE(writer->finish(0, model.stats().page_trace_dropped));
  }

  static inline storage::TemporaryDirectory* folder_ = nullptr;
  static inline std::string model_;
  static inline std::vector<std::string> traces_;
};

TEST_F(Recommendation, KeepsTheShareOfDegradedAnswersInOtherSessions) {
  const Json best = recommended("degraded<1%", traces_);
  expect_kept(best, [&](std::uint64_t seed, std::uint64_t bytes) {
    const auto figures = session(seed, bytes, best);
    return figures && static_cast<double>(figures->degraded) < 0.01 * 2000;
  });
}

TEST_F(Recommendation, KeepsTheWidthOfAnswersInOtherSessions) {
  const Json best = recommended("width<0.001", traces_);
  expect_kept(best, [&](std::uint64_t seed, std::uint64_t bytes) {
    const auto figures = session(seed, bytes, best);
    return figures && figures->width_p99 < 0.001;
  });
}

TEST_F(Recommendation, KeepsMissesOfBlockingQueriesInOtherSessions) {
  OpenOptions plenty;
  plenty.page_trace_capacity = 1 << 19;
  std::vector<std::string> traces;
  for (std::uint64_t seed = 101; seed <= 103; ++seed) {
    traces.push_back((*folder_ / ".").string() + "blocking" + std::to_string(seed) + ".trace");
    misses(seed, plenty, traces.back());
  }
  const Json best = recommended("misses<1", traces);
  expect_kept(best, [&](std::uint64_t seed, std::uint64_t bytes) {
    OpenOptions options;
    options.memory_budget_bytes = bytes;
    options.policy = policy_of(best);
    return misses(seed, options) < 1;
  });
}

TEST_F(Recommendation, SaysWhatCannotBeKept) {
  const Json best = recommended("misses<0.000001", traces_);
  EXPECT_EQ(best["kept"], false);
  EXPECT_FALSE(best.contains("memory_bytes"));
}

}  // namespace
}  // namespace planetree::tools
