// Counts the costs of real-time queries besides processor time.
// usage: check_query_costs MODEL.ptree [QUERIES]
//
// Makes QUERIES queries, ten million by default, with the minimum memory that the model opens with,
// each at another point anywhere in its box, as fast as possible: every page is evicted again and
// again meanwhile. Exit status 1 if the querying thread allocated, took a lock, made a system call
// or faulted a page in, or if the process grew or the model exceeded its budget.

#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tests/query/least_memory.h"
#include "tests/query/query_costs.h"

namespace planetree::query {
namespace {

std::vector<Vec3> random_points(const ModelInfo& info, std::size_t count) {
  std::mt19937_64 random(7);
  const auto any = [&](double from, double to) {
    return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
  };
  std::vector<Vec3> points(count);
  for (Vec3& point : points) {
    point.x = any(info.box_lower.x, info.box_upper.x);
    point.y = any(info.box_lower.y, info.box_upper.y);
    point.z = any(info.box_lower.z, info.box_upper.z);
  }
  return points;
}

// Prints a count; returns whether it is 0.
bool report(const char* what, std::uint64_t count) {
  std::printf("  %-28s %llu\n", what, static_cast<unsigned long long>(count));
  return count == 0;
}

int run(const std::string& file, std::uint64_t queries) {
  OpenOptions options;
  options.max_probes = 1;
  options.memory_budget_bytes = least_memory_bytes(file, options);
  std::vector<Vec3> points(100003);
  const std::uint64_t resident = resident_memory_bytes();
  const auto model = Model::open(file, options);
  if (!model) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), model.error().text);
    return 1;
  }
  auto probe = Probe::create(*model);
  points = random_points(model->info(), points.size());
  const QueryCosts costs =
      measure_queries(*model, *probe, points, points.size(), queries, resident);
  std::printf(
      "%llu queries with %llu bytes of memory, %llu of them locked: %llu degraded; %llu pages "
      "read, %llu evicted meanwhile\n",
      static_cast<unsigned long long>(queries),
      static_cast<unsigned long long>(options.memory_budget_bytes),
      static_cast<unsigned long long>(model->stats().locked_bytes),
      static_cast<unsigned long long>(costs.degraded),
      static_cast<unsigned long long>(costs.pages_read),
      static_cast<unsigned long long>(costs.pages_evicted));
  bool none = report("allocations", costs.allocations);
  none &= report("locks", costs.locks);
  if (costs.calls_are_counted)
    none &= report("system calls", costs.calls);
  else
    std::printf("  system calls cannot be counted here\n");
  none &= report("page faults", costs.faults);
  none &= report("bytes grown", costs.grown_bytes);
  none &= report("bytes over budget", costs.over_budget_bytes);
  return none ? 0 : 1;
}

}  // namespace
}  // namespace planetree::query

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: check_query_costs MODEL.ptree [QUERIES]\n");
    return 2;
  }
  return planetree::query::run(argv[1], argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 10000000);
}
