#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <functional>
#include <span>
#include <vector>

#include "planetree/types.h"

/// Timing of contenders that take turns on the same queries, so that other load on the machine
/// slows all of them alike.
namespace planetree::bench {

/// Time of one contender.
struct Timing {
  double median_ns = 0;  ///< per query, median over rounds
  double checksum = 0;   ///< sum of answers of the last round
};

/// Wall-clock times of the single queries of one more round.
struct Latency {
  double p999_ns = 0;  ///< 99.9th percentile
  double max_ns = 0;
};

/// Processor time of this process in nanoseconds. Contenders use one thread that never waits, and
/// other processes do not count.
inline double processor_ns() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e9 + static_cast<double>(time.tv_nsec);
}

/// Answers queries and returns a sum that depends on the answers.
using Contender = std::function<double(std::span<const Vec3>)>;

/// Returns the contender that answers one query after the other.
template <class Answer>
Contender one_by_one(Answer answer) {
  return [answer](std::span<const Vec3> queries) {
    double sum = 0;
    for (const Vec3& query : queries) sum += answer(query);
    return sum;
  };
}

/// Runs a contender over all queries. Returns nanoseconds a query; `sum` is that of the answers.
inline double time_once(const Contender& contender, const std::vector<Vec3>& queries, double& sum) {
  const double start = processor_ns();
  sum = contender(queries);
  return (processor_ns() - start) / static_cast<double>(queries.size());
}

/// Runs every contender once to warm up, then `rounds` times in turn. Timings are in their order.
inline std::vector<Timing> take_turns(const std::vector<Contender>& contenders,
                                      const std::vector<Vec3>& queries, std::size_t rounds) {
  std::vector<std::vector<double>> times(contenders.size());
  std::vector<Timing> timings(contenders.size());
  for (std::size_t round = 0; round <= rounds; ++round)
    for (std::size_t i = 0; i < contenders.size(); ++i) {
      const double ns = time_once(contenders[i], queries, timings[i].checksum);
      if (round > 0) times[i].push_back(ns);
    }
  for (std::size_t i = 0; i < contenders.size(); ++i) {
    std::nth_element(times[i].begin(), times[i].begin() + static_cast<std::ptrdiff_t>(rounds / 2),
                     times[i].end());
    timings[i].median_ns = times[i][rounds / 2];
  }
  return timings;
}

/// Times each query alone.
inline Latency latency_of(const Contender& contender, const std::vector<Vec3>& queries) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  times.reserve(queries.size());
  double sum = 0;
  for (const Vec3& query : queries) {
    const auto start = Clock::now();
    sum += contender(std::span(&query, 1));
    times.push_back(std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  volatile double kept = sum;
  static_cast<void>(kept);
  std::sort(times.begin(), times.end());
  return {.p999_ns = times[times.size() - 1 - times.size() / 1000], .max_ns = times.back()};
}

}  // namespace planetree::bench
