#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <functional>
#include <vector>

#include "planetree/types.h"

/// Two programs taking turns on the same queries, so that whatever else the
/// machine does falls on both.
namespace planetree::bench {

/// Nanoseconds per ask of each contender, median over rounds.
struct Timing {
  double median_ns = 0;
  double checksum = 0;  ///< sum of distances of the last round
};

/// Processor time of this process: both contenders are one thread that never
/// waits, and others on the machine do not count.
inline double processor_ns() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e9 + static_cast<double>(time.tv_nsec);
}

using AskDistance = std::function<double(const Vec3&)>;

inline double time_once(const AskDistance& ask, const std::vector<Vec3>& queries, double& sum) {
  sum = 0;
  const double start = processor_ns();
  for (const Vec3& query : queries) sum += ask(query);
  return (processor_ns() - start) / static_cast<double>(queries.size());
}

/// Runs every contender once to warm up, then `rounds` times in turn.
inline std::vector<Timing> take_turns(const std::vector<AskDistance>& contenders,
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

}  // namespace planetree::bench
