// Measures the first queries of a model when nothing of it is in memory, neither in the kernel's
// page cache nor in the arena.

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iostream>
#include <string>
#include <vector>

#include "bench/workloads.h"
#include "planetree/planetree.h"

namespace planetree::bench {
namespace {

struct Arguments {
  std::string model;
  std::size_t queries = 10'000;
  std::uint64_t memory_mib = 256;
};

// Only clean pages are dropped, hence the fdatasync.
bool drop_from_page_cache(const std::string& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool dropped =
      ::fdatasync(descriptor) == 0 && ::posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED) == 0;
  ::close(descriptor);
  return dropped;
}

struct Row {
  double total_us = 0;
  double max_us = 0;
  Stats stats;
};

template <class QueryOne>
Row query_all(const Model& model, const std::vector<Vec3>& points, const QueryOne& query_one) {
  using Clock = std::chrono::steady_clock;
  Row row;
  auto probe = Probe::create(model);
  if (!probe) return row;
  for (const Vec3& point : points) {
    const auto start = Clock::now();
    query_one(*probe, point);
    const double us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
    row.total_us += us;
    row.max_us = std::max(row.max_us, us);
  }
  row.stats = model.stats();
  return row;
}

Result<std::vector<Vec3>> points_of(const Arguments& arguments, Workload workload) {
  const auto model = Model::open(arguments.model);
  if (!model) return model.error();
  auto probe = Probe::create(*model);
  if (!probe) return probe.error();
  const SurfaceOf surface = [&](const Vec3& query) { return probe->closest_point(query); };
  return make_queries(workload, {model->info().core_lower, model->info().core_upper}, surface,
                      arguments.queries, 1);
}

int fail(const char* what) {
  std::cerr << "cold_bench: " << what << '\n';
  return 1;
}

int run(const Arguments& arguments) {
  fmt::print("{:<10}{:<20}{:>12}{:>12}{:>14}\n", "points", "the first queries", "queries/s",
             "max us", "pages a query");
  for (const Workload workload : {Workload::kUniform, Workload::kNear, Workload::kPath})
    for (const bool side : {false, true}) {
      const auto points = points_of(arguments, workload);
      if (!points) return fail(points.error().text);
      if (!drop_from_page_cache(arguments.model)) return fail("cannot drop the file from memory");
      const auto model =
          Model::open(arguments.model, {.memory_budget_bytes = arguments.memory_mib << 20});
      if (!model) return fail(model.error().text);
      const Row row = query_all(*model, *points, [&](Probe& probe, const Vec3& point) {
        if (side)
          probe.contains(point);
        else
          probe.closest_point(point, {.parts = kDistance});
      });
      const auto queries = static_cast<double>(points->size());
      fmt::print("{:<10}{:<20}{:>12.0f}{:>12.0f}{:>14.3f}\n", name_of(workload),
                 side ? "side" : "distance", queries / row.total_us * 1e6, row.max_us,
                 static_cast<double>(row.stats.pages_read) / queries);
    }
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Arguments arguments;
  CLI::App app("The first queries of a model of which nothing is in memory");
  app.add_option("model", arguments.model, "File that planetree build wrote")->required();
  app.add_option("--queries", arguments.queries, "Points a workload")->capture_default_str();
  app.add_option("--memory-mib", arguments.memory_mib, "Maximum memory for the model")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(arguments);
}
