// Counts the pages that a query reads, by eviction policy and memory budget. Measures no times.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <string>
#include <vector>

#include "bench/workloads.h"
#include "planetree/planetree.h"
#include "query/model_state.h"

namespace planetree::bench {
namespace {

struct Arguments {
  std::string model;
  std::size_t queries = 20'000;
  std::vector<double> percents = {2, 5, 10, 25};
};

constexpr Workload kQueried[] = {Workload::kUniform, Workload::kNear, Workload::kPath,
                                 Workload::kTeleport};

// Returns the pages read per query in the second half; the first half fills the frames.
Result<double> reads_per_query(const Arguments& arguments, const std::vector<Vec3>& points,
                               std::uint64_t budget_bytes, EvictionPolicy policy) {
  const auto model = query::ModelState::open_model(
      arguments.model, {.memory_budget_bytes = budget_bytes, .max_probes = 1, .policy = policy},
      {.starts_fetching = false});
  if (!model) return model.error();
  auto probe = Probe::create(*model);
  if (!probe) return probe.error();
  const std::size_t half = points.size() / 2;
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == half) before = model->stats().pages_read;
    (void)probe->closest_point(points[i]);
  }
  return static_cast<double>(model->stats().pages_read - before) /
         static_cast<double>(points.size() - half);
}

int fail(const char* what) {
  std::cerr << "policy_bench: " << what << '\n';
  return 1;
}

int run(const Arguments& arguments) {
  const auto model = Model::open(arguments.model, {.memory_budget_bytes = std::uint64_t{8} << 30});
  if (!model) return fail(model.error().text);
  auto probe = Probe::create(*model);
  if (!probe) return fail(probe.error().text);
  const SurfaceOf surface = [&](const Vec3& query) { return probe->closest_point(query); };
  fmt::print("{:<12}{:>10}{:>10}{:>10}\n", "points", "memory %", "clock", "lru");
  for (const Workload workload : kQueried) {
    const auto points = make_queries(workload, {model->info().core_lower, model->info().core_upper},
                                     surface, arguments.queries, 1);
    for (const double percent : arguments.percents) {
      const auto budget = static_cast<std::uint64_t>(
          percent / 100 * static_cast<double>(model->stats().arena_bytes));
      const auto clock = reads_per_query(arguments, points, budget, EvictionPolicy::kClock);
      const auto lru = reads_per_query(arguments, points, budget, EvictionPolicy::kLru);
      if (!clock || !lru) return fail((clock ? lru : clock).error().text);
      fmt::print("{:<12}{:>10}{:>10.4f}{:>10.4f}\n", name_of(workload), percent, *clock, *lru);
    }
  }
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Arguments arguments;
  CLI::App app("Pages read per query, by eviction policy");
  app.add_option("model", arguments.model, "File that planetree build wrote")->required();
  app.add_option("--queries", arguments.queries, "Points a workload; the second half counts")
      ->capture_default_str();
  app.add_option("--percents", arguments.percents, "Budgets, in % of what all pages take")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(arguments);
}
