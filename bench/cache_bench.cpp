// Counts the pages that a query reads: a benchmark for each workload, share of memory and eviction
// policy. Models of several page sizes can be compared.
// usage: cache_bench MODEL.ptree... [Google Benchmark's flags]

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/workloads.h"
#include "planetree/planetree.h"
#include "query/model_state.h"

namespace planetree::bench {
namespace {

constexpr std::size_t kQueries = 20'000;
constexpr Workload kQueried[] = {Workload::kPath, Workload::kNear, Workload::kUniform,
                                 Workload::kTeleport};
constexpr unsigned kPercents[] = {2, 5, 10, 25};

constexpr std::uint64_t kFrameTableBytes = 64;  ///< maximum of any policy

struct NamedPolicy {
  const char* name;
  EvictionPolicy policy;
};
constexpr NamedPolicy kPolicies[] = {{"clock", EvictionPolicy::kClock},
                                     {"lru", EvictionPolicy::kLru},
                                     {"sieve", EvictionPolicy::kSieve},
                                     {"s3fifo", EvictionPolicy::kS3Fifo},
                                     {"2q", EvictionPolicy::kTwoQ}};

/// Returns a budget for as many frames. It includes the tables of the policy.
Result<std::uint64_t> budget_for(const std::filesystem::path& path, OpenOptions options,
                                 std::uint64_t frames, std::uint64_t page_bytes) {
  const auto least = query::ModelState::min_budget_bytes(path, options);
  if (!least) return least.error();
  constexpr std::uint64_t kMinFrames = 4;  // with one probe and one fetch thread
  const std::uint64_t more = frames - std::min(frames, kMinFrames);
  return *least + more * (page_bytes + kFrameTableBytes);
}

/// Answers all points once, with so many frames. The first half fills the frames. The second is
/// timed and counted.
void measure(benchmark::State& state, const std::filesystem::path& path,
             const std::vector<Vec3>& points, std::uint64_t frames, std::uint64_t page_bytes,
             EvictionPolicy policy) {
  OpenOptions options{.max_probes = 1, .policy = policy};
  const auto budget = budget_for(path, options, frames, page_bytes);
  if (!budget) return state.SkipWithError(budget.error().text);
  options.memory_budget_bytes = *budget;
  const auto model = query::ModelState::open_model(path, options, {.starts_fetching = false});
  if (!model) return state.SkipWithError(model.error().text);
  auto probe = Probe::create(*model);
  if (!probe) return state.SkipWithError(probe.error().text);
  const std::size_t half = points.size() / 2;
  for (std::size_t i = 0; i < half; ++i) (void)probe->closest_point(points[i]);
  const Stats before = model->stats();
  for (auto _ : state)
    for (std::size_t i = half; i < points.size(); ++i)
      benchmark::DoNotOptimize(probe->closest_point(points[i]));
  const Stats after = model->stats();
  const auto each = [&](std::uint64_t count) {
    return static_cast<double>(count) / static_cast<double>(points.size() - half);
  };
  state.counters["misses"] = each(after.pages_read - before.pages_read);
  state.counters["lookups"] =
      each(after.page_hits + after.page_misses - before.page_hits - before.page_misses);
  state.counters["frames"] = static_cast<double>(after.frames);
  state.counters["page_bytes"] = static_cast<double>(model->info().page_bytes);
}

void add(const std::filesystem::path& path, Workload workload, const Model& model,
         const std::vector<Vec3>& points) {
  const std::uint64_t page_bytes = model.info().page_bytes, all_frames = model.stats().frames;
  for (const unsigned percent : kPercents)
    for (const auto& [policy_name, policy] : kPolicies) {
      const std::string name = path.stem().string() + '/' + name_of(workload) + '/' +
                               std::to_string(percent) + "%/" + policy_name;
      const std::uint64_t frames = all_frames * percent / 100;
      benchmark::RegisterBenchmark(name.c_str(),
                                   [=, chosen = policy](benchmark::State& state) {
                                     measure(state, path, points, frames, page_bytes, chosen);
                                   })
          ->Iterations(1)
          ->Unit(benchmark::kMillisecond);
    }
}

Result<void> add_all(const std::filesystem::path& path) {
  const auto model =
      Model::open(path, {.memory_budget_bytes = std::uint64_t{16} << 30, .max_probes = 1});
  if (!model) return model.error();
  auto probe = Probe::create(*model);
  if (!probe) return probe.error();
  const SurfaceOf surface = [&](const Vec3& query) { return probe->closest_point(query); };
  const Box box{model->info().core_lower, model->info().core_upper};
  for (const Workload workload : kQueried)
    add(path, workload, *model, make_queries(workload, box, surface, kQueries, 1));
  return {};
}

int run(const std::vector<const char*>& models) {
  for (const char* model : models) {
    if (const auto added = add_all(model); !added) {
      std::fprintf(stderr, "cache_bench: %s: %s\n", model, added.error().text);
      return 1;
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const std::vector<const char*> models(argv + 1, argv + argc);
  if (models.empty()) {
    std::fputs("usage: cache_bench MODEL.ptree... [Google Benchmark's flags]\n", stderr);
    return 2;
  }
  return planetree::bench::run(models);
}
