// Runs one kind of query again and again, to count its instructions under callgrind: a slowdown
// shows without a clock. Points are made and queried once before the counting begins.

#include <fmt/format.h>
#include <valgrind/callgrind.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <string>
#include <vector>

#include "bench/workloads.h"
#include "planetree/planetree.h"

namespace planetree::bench {
namespace {

struct Arguments {
  std::string model;
  std::string workload = "uniform";
  std::string part = "distance";
  std::size_t queries = 2000;
  double max_error = 0;  // share of the diagonal
  std::uint32_t max_work = QueryOptions::kNoLimit;
  bool never_wait = false;
};

QueryOptions options_of(const Arguments& arguments, const Box& box) {
  QueryOptions options;
  options.parts = arguments.part == "all" ? kAllParts : kDistance;
  options.max_error = arguments.max_error * box.diagonal();
  options.max_work = arguments.max_work;
  options.wait = arguments.never_wait ? Wait::kNever : Wait::kForPages;
  return options;
}

double query_all(Probe& probe, const std::vector<Vec3>& points, bool side_alone,
                 const QueryOptions& options) {
  double sum = 0;
  for (const Vec3& point : points)
    if (side_alone)
      sum += probe.contains(point, options).side == Side::kInside ? 1 : 0;
    else
      sum += probe.closest_point(point, options).distance;
  return sum;
}

int run(const Arguments& arguments) {
  const auto model = Model::open(arguments.model, {.memory_budget_bytes = std::uint64_t{16} << 30});
  if (!model) return std::cerr << "query_bench: " << model.error().text << '\n', 1;
  auto probe = Probe::create(*model);
  if (!probe) return std::cerr << "query_bench: " << probe.error().text << '\n', 1;
  const Box box{model->info().core_lower, model->info().core_upper};
  const SurfaceOf surface = [&](const Vec3& query) { return probe->closest_point(query); };
  for (const Workload workload : kWorkloads) {
    if (name_of(workload) != arguments.workload) continue;
    const auto points = make_queries(workload, box, surface, arguments.queries, 1);
    const QueryOptions options = options_of(arguments, box);
    const bool side_alone = arguments.part == "side";
    query_all(*probe, points, side_alone, {.parts = options.parts});
    query_all(*probe, points, side_alone, options);
    CALLGRIND_START_INSTRUMENTATION;
    CALLGRIND_ZERO_STATS;
    const double sum = query_all(*probe, points, side_alone, options);
    CALLGRIND_STOP_INSTRUMENTATION;
    fmt::print("{:.17g}\n", sum);
    return 0;
  }
  std::cerr << "query_bench: there is no workload '" << arguments.workload << "'\n";
  return 2;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Arguments arguments;
  CLI::App app("One kind of query again and again, run by ./dev counts");
  app.add_option("model", arguments.model, "File that planetree build wrote")->required();
  app.add_option("--workload", arguments.workload, "uniform, near, path, contact, teleport, medial")
      ->capture_default_str();
  app.add_option("--part", arguments.part, "distance, side or all")
      ->check(CLI::IsMember({"distance", "side", "all"}))
      ->capture_default_str();
  app.add_option("--queries", arguments.queries, "How many")->capture_default_str();
  app.add_option("--max-error", arguments.max_error, "Allowed error, as a share of the diagonal")
      ->capture_default_str();
  app.add_option("--max-work", arguments.max_work, "Maximum units of work of a query");
  app.add_flag("--never-wait", arguments.never_wait, "Real-time queries; all pages are in memory");
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(arguments);
}
