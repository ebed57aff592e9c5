// Measures what a batch saves over single queries, by ordering the points and by several threads.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "bench/workloads.h"
#include "planetree/planetree.h"

namespace planetree::bench {
namespace {

struct Arguments {
  std::string model;
  std::size_t points = 1'000'000;
  std::size_t rounds = 3;
  unsigned threads = 2;
  std::uint64_t memory_mib = std::uint64_t{64} << 10;
};

using Answers = std::vector<ClosestPoint>;

// One way to answer all points. `times` holds wall-clock nanoseconds a point, because more than one
// thread may work; `pages` is the number of pages that the last run read a point.
struct Way {
  std::string name;
  const Model& model;
  std::function<void(Answers&)> answer;
  Answers answers;
  std::vector<double> times{};
  double pages = 0;

  void run() {
    const auto points = static_cast<double>(answers.size());
    const std::uint64_t before = model.stats().pages_read;
    const auto start = std::chrono::steady_clock::now();
    answer(answers);
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
    times.push_back(time.count() / points);
    pages = static_cast<double>(model.stats().pages_read - before) / points;
  }
  double median() {
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
  }
};

bool same_answer(const ClosestPoint& a, const ClosestPoint& b) {
  const auto bits = [](const double& value) {
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof word);
    return word;
  };
  return bits(a.distance) == bits(b.distance) && bits(a.lower) == bits(b.lower) &&
         bits(a.upper) == bits(b.upper) && a.triangle == b.triangle && a.status == b.status;
}

int run(const Arguments& arguments) {
  OpenOptions options{.memory_budget_bytes = arguments.memory_mib << 20};
  const auto alone = Model::open(arguments.model, options);
  options.batch_threads = arguments.threads;
  const auto batch_threads = alone ? Model::open(arguments.model, options) : alone.error();
  if (!batch_threads) return std::cerr << "batch_bench: " << batch_threads.error().text << '\n', 1;
  auto probe = Probe::create(*alone), thread_probe = Probe::create(*batch_threads);
  if (!probe || !thread_probe) return std::cerr << "batch_bench: no probe\n", 1;

  const ModelInfo& info = alone->info();
  fmt::print("{} triangles, batches of {} points\n{:<10}{:<24}{:>10}{:>8}{:>8}{:>12}\n",
             info.triangles, arguments.points, "points", "", "ns", "times", "pages", "other bits");
  constexpr QueryOptions kDistanceAlone{.parts = kDistance};
  for (const Workload workload : {Workload::kUniform, Workload::kNear}) {
    const SurfaceOf surface = [&](const Vec3& query) { return probe->closest_point(query); };
    const std::vector<Vec3> points =
        make_queries(workload, {info.core_lower, info.core_upper}, surface, arguments.points, 1);
    const Answers unanswered(points.size());
    std::vector<Way> ways{
        {"one by one", *alone,
         [&](Answers& answers) {
           for (std::size_t i = 0; i < points.size(); ++i)
             answers[i] = probe->closest_point(points[i], kDistanceAlone);
         },
         unanswered},
        {"a batch", *alone,
         [&](Answers& answers) { probe->closest_points(points, answers, kDistanceAlone); },
         unanswered},
        {fmt::format("a batch, {} threads", arguments.threads), *batch_threads,
         [&](Answers& answers) { thread_probe->closest_points(points, answers, kDistanceAlone); },
         unanswered}};
    for (Way& way : ways) way.run();  // to warm up
    for (Way& way : ways) way.times.clear();
    for (std::size_t round = 0; round < arguments.rounds; ++round)
      for (Way& way : ways) way.run();
    for (Way& way : ways) {
      std::size_t other = 0;
      for (std::size_t i = 0; i < points.size(); ++i)
        other += same_answer(way.answers[i], ways[0].answers[i]) ? 0 : 1;
      fmt::print("{:<10}{:<24}{:>10.0f}{:>8.2f}{:>8.3f}{:>12}\n", name_of(workload), way.name,
                 way.median(), ways[0].median() / way.median(), way.pages, other);
    }
  }
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Arguments arguments;
  CLI::App app("Batches of points against queries one by one");
  app.add_option("model", arguments.model, "File that planetree build wrote")->required();
  app.add_option("--points", arguments.points, "Points a batch")->capture_default_str();
  app.add_option("--rounds", arguments.rounds, "Rounds in turn; their median counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--threads", arguments.threads, "Threads of the last way")->capture_default_str();
  app.add_option("--memory-mib", arguments.memory_mib, "Memory budget of the model, of each of two")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(arguments);
}
