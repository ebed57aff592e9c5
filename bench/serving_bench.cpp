// Measures the costs of real-time serving: a reader's section, installing pages, and queries while
// pages are installed.
// usage: serving_bench MODEL.ptree
//
// The querying thread has real-time priority and a processor of its own if the system grants them.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "cache/protocol.h"
#include "planetree/probe.h"
#include "query/model_state.h"
#include "tools/session/real_time.h"
#include "tools/session/session_path.h"

namespace planetree::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Nanoseconds = std::chrono::duration<double, std::nano>;

constexpr int kRounds = 9;

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

double section_ns() {
  constexpr int kSections = 2'000'000;
  cache::ReaderSlot slot;
  std::vector<double> rounds(kRounds);
  for (double& round : rounds) {
    const auto began = Clock::now();
    for (int i = 0; i < kSections; ++i) {
      slot.enter();
      slot.leave();
    }
    round = Nanoseconds(Clock::now() - began).count() / kSections;
  }
  return median(rounds);
}

/// Fetches all pages in turn. With little memory each fetch installs a page.
class Installer {
 public:
  explicit Installer(const Model& model)
      : reader_(*query::ModelState::of(model).claim_reader()), pages_(model.info().pages) {}

  void install_next() {
    reader_.enter();
    reader_.fetch(next_);
    reader_.leave();
    next_ = (next_ + 1) % pages_;
  }

 private:
  cache::Reader reader_;
  const std::uint32_t pages_;
  std::uint32_t next_ = 0;
};

double installs_a_second(const Model& model) {
  Installer installer(model);
  std::vector<double> rounds(kRounds);
  for (double& round : rounds) {
    const std::uint64_t before = model.stats().pages_read;
    const auto began = Clock::now();
    while (Clock::now() - began < std::chrono::milliseconds(500)) installer.install_next();
    const std::chrono::duration<double> taken = Clock::now() - began;
    round = static_cast<double>(model.stats().pages_read - before) / taken.count();
  }
  return median(rounds);
}

/// Times of the queries of one round: median and 99.9th percentile.
struct QueryTimes {
  double median_ns, p999_ns;
  std::size_t degraded;
};

QueryTimes query_path(Probe& probe, const std::vector<Vec3>& path) {
  constexpr std::size_t kTimes = 10;
  std::vector<double> times;
  times.reserve(kTimes * path.size());
  QueryTimes result{};
  for (std::size_t i = 0; i < kTimes * path.size(); ++i) {
    const Vec3& point = path[i % path.size()];
    const auto began = Clock::now();
    const ClosestPoint answer = probe.closest_point(point, {.wait = Wait::kNever});
    times.push_back(Nanoseconds(Clock::now() - began).count());
    result.degraded += answer.status == Status::kDegraded;
  }
  std::sort(times.begin(), times.end());
  result.median_ns = times[times.size() / 2];
  result.p999_ns = times[times.size() * 999 / 1000];
  return result;
}

void print_times(const char* what, const std::vector<QueryTimes>& rounds) {
  std::vector<double> medians, p999;
  std::size_t degraded = 0;
  for (const QueryTimes& round : rounds) {
    medians.push_back(round.median_ns);
    p999.push_back(round.p999_ns);
    degraded += round.degraded;
  }
  fmt::print("{}: median {:.0f} ns, 99.9 % {:.0f} ns, {} degraded\n", what, median(medians),
             median(p999), degraded);
}

// Queries with and without installs in turn, on the calling thread with real-time priority.
void compare_queries(const Model& model, const std::vector<Vec3>& path) {
  std::atomic<bool> installs{false}, over{false};
  const std::uint64_t before = model.stats().pages_read;
  std::thread installer([&] {
    Installer work(model);
    while (!over) installs ? work.install_next() : std::this_thread::yield();
  });
  tools::become_real_time();
  auto probe = Probe::create(model);
  std::vector<QueryTimes> idle, loaded;
  for (int round = 0; round < 2 * kRounds; ++round) {
    for (const Vec3& point : path) (void)probe->closest_point(point);  // makes the path resident
    installs = round % 2 == 1;
    (installs ? loaded : idle).push_back(query_path(*probe, path));
    installs = false;
  }
  over = true;
  installer.join();
  print_times("queries, no other load", idle);
  print_times("queries beside installs", loaded);
  fmt::print("pages read meanwhile: {}\n", model.stats().pages_read - before);
}

void measure(const Model& model) {
  const tools::RealTimeRights rights = tools::become_real_time();
  fmt::print("real-time priority: {}; pinned to one processor: {}\n", rights.fifo, rights.pinned);
  fmt::print("a section of a reader: {:.1f} ns\n", section_ns());
  fmt::print("installs a second: {:.0f}, pages of {} bytes\n", installs_a_second(model),
             model.info().page_bytes);
}

int run(const char* file) {
  OpenOptions options;
  options.max_probes = 3;
  options.locking = Locking::kTry;
  const auto whole =
      Model::open(file, {.memory_budget_bytes = ~std::uint64_t{0} / 2, .locking = Locking::kNever});
  if (!whole) {
    fmt::print(stderr, "serving_bench: {}\n", whole.error().text);
    return 1;
  }
  auto finder = Probe::create(*whole);
  constexpr std::size_t kTicks = 20000;
  const auto path = tools::touch_path(*whole, *finder, tools::TouchMotion::kGlide, kTicks);
  options.memory_budget_bytes = (whole->stats().arena_bytes + whole->stats().table_bytes) / 2;
  const auto model =
      query::ModelState::open_model(file, options, {storage::FileCalls::real(), false});
  if (!model) {
    fmt::print(stderr, "serving_bench: {}\n", model.error().text);
    return 1;
  }
  std::thread(measure, std::cref(*model)).join();
  // Each part runs in a new thread, so that threads started here do not inherit real-time priority.
  std::thread(compare_queries, std::cref(*model), std::cref(path)).join();
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: serving_bench MODEL.ptree\n", stderr);
    return 2;
  }
  return planetree::bench::run(argv[1]);
}
