// Measures a model that is read by HTTP ranges: round trips of opening and of the first query, and
// a probe that glides along the surface.
// usage: http_bench MODEL.ptree [--points N] [--delay-ms MS] [--seconds S] [--memory-mib M]
//                   [--edge LENGTH]
//
// The server is a thread of this process. It sends each reply after the delay. Round trips are
// counted, not timed: requests at once count as one. Exact distances are those of the file.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "planetree/probe.h"
#include "tests/storage/http/range_server.h"

namespace planetree::bench {
namespace {

using Clock = std::chrono::steady_clock;

struct Choices {
  std::string model;
  unsigned points = 50, delay_ms = 0, seconds = 0;
  std::uint64_t memory_mib = 64;
  double edge = 0;
  bool shows_requests = false;
};

template <class T>
T value_of(Result<T> result) {
  if (result) return *std::move(result);
  fmt::print(stderr, "{}\n", result.error().text);
  std::exit(1);
}

// Points whose distance to the surface is up to some percent of the box.
std::vector<Vec3> near_points(const Model& model, std::size_t count) {
  const Vec3 lower = model.info().core_lower, upper = model.info().core_upper;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1), away(-0.03, 0.03);
  Probe probe = value_of(Probe::create(model));
  std::vector<Vec3> points(count);
  for (Vec3& point : points) {
    const Vec3 any{lower.x + (upper.x - lower.x) * unit(random),
                   lower.y + (upper.y - lower.y) * unit(random),
                   lower.z + (upper.z - lower.z) * unit(random)};
    const Vec3 on = probe.closest_point(any).point;
    const double share = away(random);
    point = {on.x + (any.x - on.x) * share, on.y + (any.y - on.y) * share,
             on.z + (any.z - on.z) * share};
  }
  return points;
}

struct Spread {
  std::map<std::uint64_t, unsigned> counts;
  void add(std::uint64_t value) { ++counts[value]; }
  void print(const char* name) const {
    fmt::print("{:28}", name);
    for (const auto& [value, count] : counts) fmt::print("  {} x {}", count, value);
    fmt::print("\n");
  }
};

void measure_opening(const std::string& url, std::span<const Vec3> points) {
  Spread open_rounds, open_requests, rounds, requests, kib, exact;
  std::uint64_t most_open_bytes = 0;
  for (const Vec3& point : points) {
    const Model model = value_of(Model::open(url));
    const Stats opened = model.stats();
    Probe probe = value_of(Probe::create(model));
    const ClosestPoint answer = probe.closest_point(point);
    const Stats queried = model.stats();
    open_rounds.add(opened.http_rounds);
    open_requests.add(opened.http_requests);
    most_open_bytes = std::max(most_open_bytes, opened.http_bytes);
    rounds.add(queried.http_rounds - opened.http_rounds);
    requests.add(queried.http_requests - opened.http_requests);
    kib.add((queried.http_bytes - opened.http_bytes) >> 10);
    exact.add(answer.status == Status::kExact);
  }
  open_rounds.print("open: round trips");
  open_requests.print("open: requests");
  fmt::print("open: at most {} bytes\n", most_open_bytes);
  rounds.print("first query: round trips");
  requests.print("first query: requests");
  kib.print("first query: KiB");
  exact.print("first query: exact");
}

// A path along the surface, by 0.02 % of the box's diagonal a tick, a little above it.
std::vector<Vec3> glide_path(const Model& file, Probe& probe, std::size_t ticks) {
  const Vec3 lower = file.info().core_lower, upper = file.info().core_upper;
  const double diagonal = std::hypot(upper.x - lower.x, upper.y - lower.y, upper.z - lower.z);
  const double step = diagonal * 2e-4;
  std::vector<Vec3> path(ticks);
  Vec3 at = upper;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const ClosestPoint answer = probe.closest_point(at);
    const Vec3 &on = answer.point, &up = answer.normal;
    path[tick] = {on.x + up.x * step, on.y + up.y * step, on.z + up.z * step};
    // Across the normal, in a direction that turns slowly.
    const double angle = static_cast<double>(tick) * 3e-4;
    const Vec3 turn{std::cos(angle), std::sin(angle), 0.5};
    Vec3 along{up.y * turn.z - up.z * turn.y, up.z * turn.x - up.x * turn.z,
               up.x * turn.y - up.y * turn.x};
    const double length = std::max(std::hypot(along.x, along.y, along.z), 1e-9);
    at = {path[tick].x + along.x / length * step, path[tick].y + along.y / length * step,
          path[tick].z + along.z / length * step};
  }
  return path;
}

// One query that does not wait each millisecond.
void glide(const std::string& url, const Model& file, const Choices& choices) {
  Probe exact = value_of(Probe::create(file));
  const std::vector<Vec3> path = glide_path(file, exact, std::size_t{choices.seconds} * 1000);
  OpenOptions options;
  options.memory_budget_bytes = choices.memory_mib << 20;
  const Model model = value_of(Model::open(url, options));
  Probe probe = value_of(Probe::create(model));
  std::vector<ClosestPoint> answers(path.size());
  std::chrono::nanoseconds slowest{0};
  const Clock::time_point start = Clock::now();
  for (std::size_t tick = 0; tick < path.size(); ++tick) {
    std::this_thread::sleep_until(start + std::chrono::milliseconds(tick));
    const Vec3 &at = path[tick], &last = path[tick > 0 ? tick - 1 : 0];
    const Clock::time_point began = Clock::now();
    probe.motion(at, {(at.x - last.x) * 1e3, (at.y - last.y) * 1e3, (at.z - last.z) * 1e3});
    answers[tick] = probe.closest_point(at, {.wait = Wait::kNever});
    slowest = std::max<std::chrono::nanoseconds>(slowest, Clock::now() - began);
  }
  const double edge = choices.edge;
  std::size_t is_exact = 0, is_near = 0, wrong = 0;
  std::vector<unsigned> far(choices.seconds);  // neither exact nor near, by second
  for (std::size_t tick = 0; tick < path.size(); ++tick) {
    const double truth = exact.closest_point(path[tick]).upper;
    const ClosestPoint& answer = answers[tick];
    wrong += truth < answer.lower * (1 - 1e-12) || truth > answer.upper * (1 + 1e-12);
    if (answer.status == Status::kExact)
      ++is_exact;
    else if (answer.upper - truth <= edge && truth - answer.lower <= edge)
      ++is_near;
    else
      ++far[tick / 1000];
  }
  const double all = static_cast<double>(path.size()) / 100;
  const Stats stats = model.stats();
  fmt::print(
      "glide: {} ticks, {:.2f} % exact, {:.2f} % more within an edge of {:.4g}, {} intervals "
      "without the distance\n"
      "glide: slowest query {:.3f} ms; {} pages prefetched, {} evicted, {} requests, {:.1f} MiB\n",
      path.size(), static_cast<double>(is_exact) / all, static_cast<double>(is_near) / all, edge,
      wrong, static_cast<double>(slowest.count()) / 1e6, stats.pages_prefetched,
      stats.pages_evicted, stats.http_requests, static_cast<double>(stats.http_bytes) / 0x1p20);
  fmt::print("glide: other ticks by second: {}\n", fmt::join(far, " "));
}

int run(const Choices& choices) {
  storage::RangeServer server(storage::text_of(choices.model));
  server.set_rule(
      [&choices](const storage::RangeServer::Request& request, storage::RangeServer::Reply& reply) {
        reply.delay_ms = choices.delay_ms;
        if (choices.shows_requests)
          fmt::print("  {} KiB at {} KiB\n", (request.last + 1 - request.first) >> 10,
                     request.first >> 10);
      });
  const Model file = value_of(Model::open(choices.model));
  measure_opening(server.url(), near_points(file, choices.points));
  if (choices.seconds > 0) glide(server.url(), file, choices);
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Choices choices;
  CLI::App app("Measures a model that is read by HTTP ranges");
  app.add_option("MODEL", choices.model, "a .ptree file")->required();
  app.add_option("--points", choices.points, "first queries, each after opening (50)");
  app.add_option("--delay-ms", choices.delay_ms, "latency of the server (0)");
  app.add_option("--seconds", choices.seconds, "duration of the glide; 0: none (0)");
  app.add_option("--memory-mib", choices.memory_mib, "memory of the glide (64)");
  app.add_option("--edge", choices.edge, "median edge of the mesh, to compare errors with (0)");
  app.add_flag("--show-requests", choices.shows_requests, "print each request");
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(choices);
}
