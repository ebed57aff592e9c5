// Measures a build, by phase and by memory limit, next to Embree's build.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "bench/peer_kinds.h"
#include "octree/builder/tree_builder.h"

namespace planetree::bench {
namespace {

struct Arguments {
  std::string mesh;
  std::string folder = ".";
  std::vector<std::uint64_t> memory_mib = {16384, 512};
  unsigned threads = 2;
  bool with_peer = true;
};

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point started) {
  return std::chrono::duration<double>(Clock::now() - started).count();
}

// Measures the time of each phase.
class PhaseClock final : public octree::BuildProgress {
 public:
  Result<void> progress(octree::BuildPhase phase, std::uint64_t, std::uint64_t) override {
    if (phase == phase_ && started_) return {};
    finish();
    phase_ = phase;
    since_ = Clock::now();
    started_ = true;
    return {};
  }
  void finish() {
    if (!started_) return;
    seconds_.emplace_back(phase_, seconds_since(since_));
    started_ = false;
  }
  const std::vector<std::pair<octree::BuildPhase, double>>& seconds() const { return seconds_; }

 private:
  octree::BuildPhase phase_ = octree::BuildPhase::kReading;
  Clock::time_point since_;
  bool started_ = false;
  std::vector<std::pair<octree::BuildPhase, double>> seconds_;
};

// Builds with one memory limit and prints a line. `peer_s` is the time of Embree's build; 0 if
// not measured.
int build(const Arguments& arguments, std::uint64_t memory_mib, double peer_s) {
  const std::filesystem::path output =
      std::filesystem::path(arguments.folder) / "build_bench.ptree";
  octree::BuildOptions options;
  options.threads = arguments.threads;
  options.memory_bytes = memory_mib << 20;
  options.replace = true;
  PhaseClock clock;
  const auto report = octree::build_tree(arguments.mesh, output, options, clock);
  clock.finish();
  if (!report) {
    fmt::print(stderr, "build_bench: {}\n", report.error().text);
    return 1;
  }
  std::error_code ignored;
  std::filesystem::remove(output, ignored);
  double all = 0, parsing = 0;
  std::string phases;
  for (const auto& [phase, seconds] : clock.seconds()) {
    all += seconds;
    if (phase == octree::BuildPhase::kReading) parsing = seconds;
    phases += fmt::format("  {} {:.1f}", octree::name_of(phase), seconds);
  }
  struct rusage usage = {};
  ::getrusage(RUSAGE_SELF, &usage);
  fmt::print("{:>7} MiB {:8.1f} s {:8.1f} s {:8} {:6} MiB {}\n", memory_mib, all, all - parsing,
             peer_s > 0 ? fmt::format("{:.1f}", (all - parsing) / peer_s) : "-",
             usage.ru_maxrss >> 10, phases);
  return 0;
}

// Builds in a child process, so that the peak memory is that of this build.
bool build_apart(const Arguments& arguments, std::uint64_t memory_mib, double peer_s) {
  std::fflush(stdout);
  const pid_t child = ::fork();
  if (child == 0) {
    const int status = build(arguments, memory_mib, peer_s);
    std::fflush(stdout);
    ::_exit(status);
  }
  int status = 1;
  return child > 0 && ::waitpid(child, &status, 0) == child && status == 0;
}

// Measures Embree in a child process, so that its threads and memory go away. Returns 0 on failure.
double peer_seconds(const Arguments& arguments) {
  int ends[2];
  if (::pipe(ends) != 0) return 0;
  const pid_t child = ::fork();
  if (child == 0) {
    double seconds = 0;
    if (const auto mesh = read_peer_mesh(arguments.mesh.c_str()))
      seconds = embree_build_seconds(*mesh, arguments.threads);
    ::_exit(::write(ends[1], &seconds, sizeof seconds) == sizeof seconds ? 0 : 1);
  }
  double seconds = 0;
  ::close(ends[1]);
  if (::read(ends[0], &seconds, sizeof seconds) != sizeof seconds) seconds = 0;
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return seconds;
}

int run(const Arguments& arguments) {
  const double peer_s = arguments.with_peer ? peer_seconds(arguments) : 0;
  if (peer_s > 0) fmt::print("Embree, {} threads: {:.1f} s\n", arguments.threads, peer_s);
  fmt::print("{:>11} {:>10} {:>10} {:>8} {:>10}\n", "limit", "total", "no parsing", "Embree's",
             "peak");
  for (const std::uint64_t memory_mib : arguments.memory_mib)
    if (!build_apart(arguments, memory_mib, peer_s)) return 1;
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Arguments arguments;
  CLI::App app("Measures a build next to Embree's build of medium quality");
  app.add_option("mesh", arguments.mesh, "Mesh to build from")->required();
  app.add_option("--folder", arguments.folder, "Where the tree and temporary files go")
      ->capture_default_str();
  app.add_option("--memory-mib", arguments.memory_mib, "Memory limits, one build for each")
      ->capture_default_str();
  app.add_option("--threads", arguments.threads, "Threads of both builds")->capture_default_str();
  app.add_flag("!--alone", arguments.with_peer, "Without Embree, which holds the mesh in memory");
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(arguments);
}
