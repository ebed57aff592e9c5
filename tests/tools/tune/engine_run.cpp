#include "tests/tools/tune/engine_run.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "tools/cli/policy_option.h"
#include "tools/tune/optimum.h"
#include "tools/tune/policy_replay.h"

namespace planetree::tools {
namespace {

[[noreturn]] void fail(const char* text) {
  std::fprintf(stderr, "engine run: %s\n", text);
  std::abort();
}

std::uint64_t least_budget(const std::filesystem::path& model, EvictionPolicy policy) {
  OpenOptions options;
  options.max_probes = 1;
  options.policy = policy;
  const auto least = query::ModelState::min_budget_bytes(model, options);
  if (!least) fail(least.error().text);
  return *least;
}

void drain(const Model& model, TraceAnalysis& analysis) {
  std::array<PageAccess, 1024> accesses;
  for (std::size_t got = accesses.size(); got == accesses.size();) {
    got = model.drain_page_trace(accesses);
    for (std::size_t i = 0; i < got; ++i) analysis.add(accesses[i]);
  }
}

void answer(const Model& model, const EngineWork& work, bool traces, TraceAnalysis& analysis) {
  auto probe = Probe::create(model);
  if (!probe) fail(probe.error().text);
  // The ring of the trace holds the lookups of so many queries.
  constexpr std::size_t kPieces = 128;
  if (traces) drain(model, analysis);
  if (work.is_batch) {
    std::vector<ClosestPoint> answers(work.points.size());
    probe->closest_points(work.points, answers);
    if (traces) drain(model, analysis);
    return;
  }
  for (std::size_t i = 0; i < work.points.size(); ++i) {
    (void)probe->closest_point(work.points[i]);
    if (i % 7 == 0) (void)probe->contains(work.points[i / 2]);
    if (traces && i % kPieces == 0) drain(model, analysis);
  }
  if (traces) drain(model, analysis);
}

}  // namespace

std::vector<Vec3> engine_path(const std::filesystem::path& model, TouchMotion motion,
                              std::size_t ticks) {
  const auto opened = Model::open(model, {.max_probes = 1});
  if (!opened) fail(opened.error().text);
  auto probe = Probe::create(*opened);
  if (!probe) fail(probe.error().text);
  return touch_path(*opened, *probe, motion, ticks, kTouchSeed);
}

EngineRun run_engine(const EngineWork& work, EvictionPolicy policy, std::uint64_t budget,
                     bool traces) {
  OpenOptions options;
  options.memory_budget_bytes = budget;
  options.max_probes = 1;
  options.policy = policy;
  options.locking = Locking::kNever;
  options.page_trace_capacity = traces ? std::uint32_t{1} << 22 : 0;
  const auto model = query::ModelState::open_model(work.model, options, {.starts_fetching = false});
  if (!model) fail(model.error().text);
  EngineRun run;
  const std::uint64_t before = model->stats().pages_read;
  answer(*model, work, traces, run.analysis);
  run.frames = static_cast<std::uint32_t>(model->stats().frames);
  run.misses = model->stats().pages_read - before;
  if (model->stats().page_trace_dropped > 0) fail("the trace dropped records");
  return run;
}

std::vector<EngineComparison> compare_engine(const EngineWork& work, std::size_t budgets,
                                             std::uint64_t most) {
  constexpr std::uint64_t kTraceBytes = std::uint64_t{256} << 20;
  const EngineRun traced = run_engine(work, EvictionPolicy::kClock, most + kTraceBytes, true);
  const References& references = traced.analysis.references();
  std::vector<EngineComparison> comparisons;
  for (std::size_t i = 0; i < budgets; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(budgets - 1);
    for (const EvictionPolicy policy : kAllPolicies) {
      const double least = static_cast<double>(least_budget(work.model, policy));
      const auto budget = static_cast<std::uint64_t>(
          std::ceil(least * std::pow(static_cast<double>(most) / least, share)));
      const EngineRun run = run_engine(work, policy, budget, false);
      const std::uint32_t frames[] = {run.frames};
      comparisons.push_back({policy, budget, run.frames, run.misses,
                             replayed_misses(references, policy, run.frames),
                             optimum_misses(references, frames).front()});
    }
  }
  return comparisons;
}

}  // namespace planetree::tools
