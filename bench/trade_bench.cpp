// Measures what an allowed error, a limit of work and not waiting save: a benchmark for each option
// and workload, with counts of what a query visits and the width of the intervals.
// usage: trade_bench MODEL.ptree [Google Benchmark's flags]

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "bench/workloads.h"
#include "planetree/planetree.h"
#include "query/answer/closest_point.h"
#include "query/model_state.h"
#include "query/probe_state.h"
#include "query/serve/page_accessor.h"

namespace planetree::bench {
namespace {

constexpr std::size_t kQueries = 5000;
constexpr Workload kMeasured[] = {Workload::kUniform, Workload::kNear, Workload::kPath,
                                  Workload::kContact};

/// A way to ask.
struct Option {
  std::string name;
  QueryOptions options;
};

std::vector<Option> options_of(double diagonal) {
  std::vector<Option> all{{"exact", {}}};
  for (const char* share : {"1e-4", "1e-3", "1e-2"})
    all.push_back({std::string("error ") + share, {.max_error = std::stod(share) * diagonal}});
  for (const std::uint32_t work : {8U, 16U, 32U, 64U})
    all.push_back({"work " + std::to_string(work), {.max_work = work}});
  all.push_back({"never wait", {.wait = Wait::kNever}});
  return all;
}

/// A model without fetch threads, with a probe.
class Opened {
 public:
  static std::unique_ptr<Opened> open(const char* path) {
    auto model = query::ModelState::open(
        path, {.memory_budget_bytes = std::uint64_t{16} << 30, .max_probes = 1},
        {.starts_fetching = false});
    if (!model) return refuse(model.error());
    auto reader = (*model)->claim_reader();
    if (!reader) return refuse(reader.error());
    return std::unique_ptr<Opened>(new Opened(std::move(*model), std::move(*reader)));
  }

  query::ModelState& model() { return *model_; }
  query::ProbeState& probe() { return *probe_; }

 private:
  Opened(std::unique_ptr<query::ModelState> model, cache::Reader reader)
      : model_(std::move(model)),
        probe_(query::ProbeState::create(model_->serving(), std::move(reader))) {}
  static std::unique_ptr<Opened> refuse(const Error& error) {
    std::fprintf(stderr, "trade_bench: %s\n", error.text);
    return nullptr;
  }

  std::unique_ptr<query::ModelState> model_;
  std::unique_ptr<query::ProbeState> probe_;
};

/// What a query takes and what its answer is worth.
using Counters = std::map<std::string, double>;

/// Counts over all points, once. Pages are those that were read meanwhile.
Counters count(Opened& opened, const std::vector<Vec3>& points, const QueryOptions& asked,
               double diagonal) {
  const std::uint64_t pages_before = opened.model().stats().pages_read;
  const QueryOptions options = query::with_defaults(asked);
  query::ProbeState& probe = opened.probe();
  octree::TraversalStats work;
  std::vector<double> widths;
  for (const Vec3& point : points) {
    query::PageAccessor accessor(probe.reader(), options.wait);
    ClosestPoint answer = query::unanswered(Status::kExact);
    query::closest_point({opened.model().geometry(), accessor.pages(), probe.coherence(), work},
                         point, options, answer);
    widths.push_back((answer.upper - answer.lower) / diagonal);
  }
  std::sort(widths.begin(), widths.end());
  const auto count = static_cast<double>(points.size());
  const auto each = [count](std::uint64_t all) { return static_cast<double>(all) / count; };
  const auto width = [&](double share) {
    return widths[static_cast<std::size_t>(share * (count - 1))];
  };
  return {{"nodes", each(work.nodes)},
          {"blocks", each(work.blocks)},
          {"triangles", each(work.triangles)},
          {"units", each(work.units)},
          {"page_switches", each(work.page_switches)},
          {"pages_read", each(opened.model().stats().pages_read - pages_before)},
          {"width_p50", width(0.5)},
          {"width_p99", width(0.99)}};
}

/// Answers one point an iteration, in turn, with all pages in memory.
void measure(benchmark::State& state, query::ProbeState& probe, const std::vector<Vec3>& points,
             const QueryOptions& options, const Counters& counters) {
  std::size_t at = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(probe.closest_point(points[at], options));
    if (++at == points.size()) at = 0;
  }
  for (const auto& [name, value] : counters) state.counters[name] = value;
}

class Bench {
 public:
  explicit Bench(const char* path) : path_(path), resident_(Opened::open(path)) {}

  bool add_all() {
    if (!resident_) return false;
    const ModelInfo& info = resident_->model().info();
    const Box box{info.core_lower, info.core_upper};
    const SurfaceOf surface = [&](const Vec3& point) {
      return resident_->probe().closest_point(point, {});
    };
    points_.reserve(std::size(kMeasured));
    for (const Workload workload : kMeasured) {
      points_.push_back(make_queries(workload, box, surface, kQueries, 1));
      for (const Vec3& point : points_.back()) surface(point);  // brings the pages into memory
      for (const Option& option : options_of(box.diagonal()))
        if (!add(name_of(workload) + ", " + option.name, points_.back(), option.options,
                 box.diagonal()))
          return false;
    }
    return true;
  }

 private:
  /// Counts with a model of which no page is in memory, unless the queries do not wait for any.
  bool add(const std::string& name, const std::vector<Vec3>& points, const QueryOptions& options,
           double diagonal) {
    const bool waits = options.wait == Wait::kForPages;
    const auto fresh = waits ? Opened::open(path_) : nullptr;
    if (waits && !fresh) return false;
    benchmark::RegisterBenchmark(
        name.c_str(),
        [this, &points, options,
         counters = count(waits ? *fresh : *resident_, points, options, diagonal)](auto& state) {
          measure(state, resident_->probe(), points, options, counters);
        });
    return true;
  }

  const char* path_;
  std::unique_ptr<Opened> resident_;
  std::vector<std::vector<Vec3>> points_;
};

int run(int argc, char** argv) {
  Bench bench(argv[1]);
  if (!bench.add_all()) return 1;
  int flags = argc - 1;
  benchmark::Initialize(&flags, argv + 1);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: trade_bench MODEL.ptree [Google Benchmark's flags]\n", stderr);
    return 2;
  }
  return planetree::bench::run(argc, argv);
}
