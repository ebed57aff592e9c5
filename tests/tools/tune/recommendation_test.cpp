// Recommendations of `planetree tune`, tried in sessions of other seeds.

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "planetree/planetree.h"
#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/cli/captured_console.h"
#include "tools/cli/policy_option.h"
#include "tools/session/session_trace.h"
#include "tools/trace_file/trace_writer.h"

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

  /// Share of degraded answers in a session of another seed; 1 if the model cannot be opened.
  static double degraded(int seed, std::uint64_t bytes, const std::string& policy) {
    const Outcome session = run({"touch", model_, "--deterministic", "--seconds", "2", "--path",
                                 "scratch", "--json", "--seed", std::to_string(seed), "--memory",
                                 std::to_string(bytes), "--policy", policy});
    if (session.status != 0) return 1;
    const Json report = Json::parse(session.output);
    return report["degraded"].get<double>() / report["ticks"].get<double>();
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
  ASSERT_EQ(best["kept"], true);
  const std::uint64_t bytes = best["memory_bytes"];
  int kept = 0, kept_with_less = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    kept += degraded(seed, bytes, best["policy"]) < 0.01;
    kept_with_less += degraded(seed, bytes * 8 / 10, best["policy"]) < 0.01;
  }
  EXPECT_GE(kept, 19) << best;
  EXPECT_LE(kept_with_less, 5) << best;
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
  ASSERT_EQ(best["kept"], true) << best;
  OpenOptions options, less;
  for (const EvictionPolicy policy : kAllPolicies)
    if (best["policy"] == name_of(policy)) options.policy = less.policy = policy;
  options.memory_budget_bytes = best["memory_bytes"];
  less.memory_budget_bytes = options.memory_budget_bytes * 8 / 10;
  int kept = 0, kept_with_less = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    kept += misses(seed, options) < 1;
    kept_with_less += misses(seed, less) < 1;
  }
  EXPECT_GE(kept, 19) << best;
  EXPECT_LE(kept_with_less, 5) << best;
}

TEST_F(Recommendation, SaysWhatCannotBeKept) {
  const Json best = recommended("misses<0.000001", traces_);
  EXPECT_EQ(best["kept"], false);
  EXPECT_FALSE(best.contains("memory_bytes"));
}

}  // namespace
}  // namespace planetree::tools
