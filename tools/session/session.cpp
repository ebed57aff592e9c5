#include "tools/session/session.h"

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <limits>
#include <thread>

namespace planetree::tools {
namespace {

using std::chrono::nanoseconds;

nanoseconds now() noexcept {
  timespec time{};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return std::chrono::seconds(time.tv_sec) + nanoseconds(time.tv_nsec);
}

void sleep_until(nanoseconds due) noexcept {
  timespec time{};
  time.tv_sec = static_cast<time_t>(due.count() / 1'000'000'000);
  time.tv_nsec = static_cast<long>(due.count() % 1'000'000'000);
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) != 0) {
  }
}

std::uint32_t in_32_bits(nanoseconds time) noexcept {
  constexpr std::int64_t kMax = std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(time.count(), 0, kMax));
}

void run_ticks(TouchProbe probe, TouchTool& tool, std::span<const Vec3> path, nanoseconds start,
               nanoseconds period, const QueryOptions& options, const TickAction& begin_tick,
               TouchRecord& record) noexcept {
  record.rights = become_real_time();
  // One query before the ticks, so that the faults of first accesses are not counted.
  if (begin_tick) begin_tick(0);
  tool.begin(probe, path.front(), options);
  sleep_until(now());
  const ThreadUsage before = thread_usage();
  for (std::size_t i = 0; i < path.size(); ++i) {
    const nanoseconds due = start + period * static_cast<std::int64_t>(i);
    sleep_until(due);
    if (begin_tick) begin_tick(i);
    const nanoseconds began = now();
    probe.motion(path[i], velocity_at(path, i, period));
    const ToolAnswer answer = tool.move(probe, path[i], options);
    const nanoseconds ended = now();
    Tick& tick = record.ticks[i] = Tick::of(answer);
    tick.latency_ns = in_32_bits(ended - due);
    tick.query_ns = in_32_bits(ended - began);
  }
  const ThreadUsage after = thread_usage();
  record.usage = {after.faults - before.faults,
                  after.voluntary_switches - before.voluntary_switches,
                  after.involuntary_switches - before.involuntary_switches};
}

void run_idle_thread(nanoseconds start, nanoseconds period,
                     std::vector<std::uint32_t>& floor_ns) noexcept {
  become_real_time();
  for (std::size_t i = 0; i < floor_ns.size(); ++i) {
    const nanoseconds due = start + period * static_cast<std::int64_t>(i);
    sleep_until(due);
    floor_ns[i] = in_32_bits(now() - due);
  }
}

}  // namespace

Vec3 velocity_at(std::span<const Vec3> path, std::size_t tick, nanoseconds period) noexcept {
  if (tick == 0) return {};
  const double per_second = 1e9 / static_cast<double>(period.count());
  const Vec3 &from = path[tick - 1], &to = path[tick];
  return {(to.x - from.x) * per_second, (to.y - from.y) * per_second, (to.z - from.z) * per_second};
}

TouchRecord run_touch_session(TouchProbe probe, TouchTool& tool, std::span<const Vec3> path,
                              nanoseconds period, std::uint32_t parts,
                              const TickAction& begin_tick) {
  const QueryOptions options{.parts = parts, .wait = Wait::kNever};
  TouchRecord record;
  record.ticks.resize(path.size());
  record.floor_ns.resize(path.size());
  const nanoseconds start = now() + std::chrono::milliseconds(20);
  std::thread querying(
      [&] { run_ticks(probe, tool, path, start, period, options, begin_tick, record); });
  std::thread idle([&] { run_idle_thread(start + period / 2, period, record.floor_ns); });
  querying.join();
  idle.join();
  return record;
}

}  // namespace planetree::tools
