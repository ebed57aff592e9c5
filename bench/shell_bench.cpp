// Times the wrenches of a point shell that slides along a model, and under callgrind counts their
// instructions. The shell is a ball; a spring pulls it along and onto the surface, without a clock,
// so that every run takes the same path.

#include <fmt/format.h>
#include <valgrind/callgrind.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "planetree/planetree.h"

namespace planetree::bench {
namespace {

struct Arguments {
  std::string model;
  std::string depth = "solid", shape = "ball";
  std::size_t points = 1000;
  std::size_t ticks = 1000;
  std::uint64_t memory_mib = 8192;
  double size = 0.02;   // radius of the ball, as a share of the diagonal
  double pull = 0.3;    // of the device below the tool's first pose, as a share of the radius
  double speed = 1e-3;  // of the device in a tick, as a share of the radius
  bool never_wait = false;
  bool forget = false;
  bool check = false;
  std::uint32_t max_work = QueryOptions::kNoLimit;
};

Vec3 sum(const Vec3& a, const Vec3& b, double times) {
  return {a.x + b.x * times, a.y + b.y * times, a.z + b.z * times};
}
double length(const Vec3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

// Points on a spiral from pole to pole.
std::vector<ShellPoint> ball(std::size_t count, double radius) {
  constexpr double kGoldenAngle = 2.399963229728653;
  std::vector<ShellPoint> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double around = std::sqrt(1 - z * z), turn = kGoldenAngle * static_cast<double>(i);
    const Vec3 at{around * std::cos(turn), around * std::sin(turn), z};
    points.push_back({sum({}, at, radius), sum({}, at, -1 / length(at))});
  }
  return points;
}

// Points of a grid on each face of a cube.
std::vector<ShellPoint> cube(std::size_t count, double half) {
  const auto edge = static_cast<int>(std::sqrt(static_cast<double>(count) / 6));
  std::vector<ShellPoint> points;
  for (const int axis : {0, 1, 2})
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < edge; ++i)
        for (int j = 0; j < edge; ++j) {
          const double at[] = {side, (2 * i + 1.0) / edge - 1, (2 * j + 1.0) / edge - 1};
          const double into[] = {-side, 0, 0};
          const auto first = static_cast<std::size_t>(3 - axis);
          const auto turned = [&](const double* of) {
            return Vec3{of[first % 3], of[(first + 1) % 3], of[(first + 2) % 3]};
          };
          points.push_back({sum({}, turned(at), half), turned(into)});
        }
  return points;
}

struct Totals {
  std::vector<double> microseconds;
  std::size_t contacts = 0, queries = 0, undecided = 0, degraded = 0;
  std::uint64_t work = 0, most_work = 0;
  std::size_t broken = 0;  // wrenches farther from the exact one than they promise
  double widest = 0;

  void add(const Wrench& wrench, double us) {
    microseconds.push_back(us);
    contacts += wrench.contacts;
    queries += wrench.queries;
    undecided += wrench.undecided;
    degraded += wrench.status != Status::kExact;
    work += wrench.work;
    most_work = std::max(most_work, wrench.work);
    widest = std::max(widest, wrench.force_error);
  }
  void print() {
    std::sort(microseconds.begin(), microseconds.end());
    const auto n = static_cast<double>(microseconds.size());
    const auto at = [&](double share) {
      return microseconds[static_cast<std::size_t>(share * (n - 1))];
    };
    fmt::print(
        "us p50 {:.1f} p99 {:.1f} max {:.1f}; per tick {:.1f} contacts {:.1f} queries {:.1f} "
        "work (most {}); {} ticks degraded, {:.2f} points undecided, widest error {:.3g}\n",
        at(0.5), at(0.99), at(1), static_cast<double>(contacts) / n,
        static_cast<double>(queries) / n, static_cast<double>(work) / n, most_work, degraded,
        static_cast<double>(undecided) / n, widest);
    if (broken > 0) fmt::print("{} wrenches broke their promise\n", broken);
  }
};

double distance(const Vec3& a, const Vec3& b) { return length(sum(a, b, -1)); }

// Whether both may be about the same true wrench.
bool agree(const Wrench& a, const Wrench& b) {
  return distance(a.force, b.force) <= a.force_error + b.force_error &&
         distance(a.torque, b.torque) <= a.torque_error + b.torque_error;
}

// Lowers the ball over the middle of the model's top while it is certainly free.
Vec3 start(const ModelInfo& info, Probe& probe, double radius) {
  Vec3 at = sum(info.core_lower, sum(info.core_upper, info.core_lower, -1), 0.5);
  at.z = info.core_upper.z + 2 * radius;
  for (int i = 0; i < 1000; ++i) {
    const double free = probe.closest_point(at, {.parts = kDistance}).lower - 1.8 * radius;
    if (free < 0.01 * radius) break;
    at.z -= free;
  }
  return at;
}

// A thread's access to shell and model.
struct Access {
  Probe probe;
  PointShellState state;
};

Totals slide(const PointShell& shell, Access& access, Access& exact, Vec3 device, double radius,
             const Arguments& arguments) {
  ShellOptions options;
  options.margin = 0.01 * radius;
  options.max_depth = radius;
  options.wait = arguments.never_wait ? Wait::kNever : Wait::kForPages;
  options.max_work = arguments.max_work;
  options.depth_rule = arguments.depth == "two-sided" ? DepthRule::kTwoSided : DepthRule::kSolid;
  const double points = static_cast<double>(shell.size());
  const double step = arguments.speed * radius, spring = 0.05 * points;
  Totals totals;
  Pose tool{{}, device};
  device.z -= arguments.pull * radius;
  for (std::size_t tick = 0; tick < arguments.ticks; ++tick) {
    if (arguments.forget) access.state.reset();
    const double turn = 1e-3 * static_cast<double>(tick);
    tool.rotation = {std::cos(turn), 0.6 * std::sin(turn), 0, 0.8 * std::sin(turn)};
    CALLGRIND_START_INSTRUMENTATION;
    const auto begin = std::chrono::steady_clock::now();
    const Wrench wrench = shell.wrench(access.probe, access.state, tool, options);
    const auto end = std::chrono::steady_clock::now();
    CALLGRIND_STOP_INSTRUMENTATION;
    totals.add(wrench, std::chrono::duration<double, std::micro>(end - begin).count());
    if (arguments.check) {
      ShellOptions blocking = options;
      blocking.wait = Wait::kForPages;
      blocking.max_work = QueryOptions::kNoLimit;
      totals.broken += !agree(wrench, shell.wrench(exact.probe, exact.state, tool, blocking));
    }
    device = sum(device, {1, 0.3, 0}, step);
    const Vec3 pull = sum(device, tool.translation, -1);
    tool.translation = sum(tool.translation, sum(wrench.force, pull, spring), 1 / points);
  }
  return totals;
}

int run(const Arguments& arguments) {
  OpenOptions open;
  open.memory_budget_bytes = arguments.memory_mib << 20;
  const auto model = Model::open(arguments.model, open);
  if (!model) return std::cerr << "shell_bench: " << model.error().text << '\n', 1;
  const ModelInfo& info = model->info();
  const double radius = arguments.size * length(sum(info.core_upper, info.core_lower, -1));
  const auto shell = PointShell::create(arguments.shape == "cube" ? cube(arguments.points, radius)
                                                                  : ball(arguments.points, radius));
  if (!shell) return std::cerr << "shell_bench: " << shell.error().text << '\n', 1;
  std::vector<Access> accesses;
  for (int i = 0; i < 2; ++i) {
    auto probe = Probe::create(*model);
    if (!probe) return std::cerr << "shell_bench: " << probe.error().text << '\n', 1;
    auto state = PointShellState::create(*shell, *model);
    if (!state) return std::cerr << "shell_bench: " << state.error().text << '\n', 1;
    accesses.push_back({std::move(*probe), std::move(*state)});
  }
  const Vec3 device = start(info, accesses[1].probe, radius);
  Totals totals = slide(*shell, accesses[0], accesses[1], device, radius, arguments);
  totals.print();
  return totals.broken == 0 ? 0 : 1;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Arguments arguments;
  CLI::App app("Times and instructions of the wrenches of a point shell");
  app.add_option("model", arguments.model, "File that planetree build wrote")->required();
  app.add_option("--points", arguments.points, "Points of the shell")->capture_default_str();
  app.add_option("--ticks", arguments.ticks, "How many wrenches")->capture_default_str();
  app.add_option("--memory", arguments.memory_mib, "Budget, MiB")->capture_default_str();
  app.add_option("--size", arguments.size, "Radius, as a share of the diagonal")
      ->capture_default_str();
  app.add_option("--speed", arguments.speed, "Step of a tick, as a share of the radius")
      ->capture_default_str();
  app.add_option("--pull", arguments.pull, "Depth of the device, as a share of the radius")
      ->capture_default_str();
  app.add_option("--shape", arguments.shape, "ball or cube")
      ->check(CLI::IsMember({"ball", "cube"}))
      ->capture_default_str();
  app.add_option("--depth", arguments.depth, "solid or two-sided")
      ->check(CLI::IsMember({"solid", "two-sided"}))
      ->capture_default_str();
  app.add_option("--max-work", arguments.max_work, "Limit of each wrench");
  app.add_flag("--never-wait", arguments.never_wait, "Real-time queries");
  app.add_flag("--forget", arguments.forget, "Reset the state before each wrench");
  app.add_flag("--check", arguments.check, "Compare each wrench with an exact one");
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(arguments);
}
