#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "planetree/types.h"

namespace planetree::tools {

/// The quantiles of a measured value.
struct TradeQuantiles {
  double p50 = 0, p99 = 0, most = 0;
};

/// What a setting's answers to the points of a workload are worth, and what they cost.
struct TradeResult {
  std::size_t points = 0;
  double seconds = 0;            ///< processor time of the querying thread for all points
  double ratio_to_exact = 0;     ///< `seconds` over that of exact answers to the same points
  std::uint64_t pages = 0;       ///< pages that were read, of a model of which none was in memory
  TradeQuantiles promised;       ///< upper - lower, model units
  TradeQuantiles actual;         ///< |distance - true distance|, model units
  std::size_t broken = 0;        ///< intervals that do not hold the true distance
  std::size_t exact = 0;         ///< answers of Status::kExact
  std::size_t degraded = 0;      ///< answers of Status::kDegraded
  std::size_t side_unknown = 0;  ///< answers without a side
  std::size_t side_wrong = 0;    ///< answers with another side than the exact one
};

/// Returns the processor time of the calling thread so far, in seconds.
double thread_seconds();

/// Compares answers with exact answers to the same points. An interval is broken if it and the
/// interval of the exact answer, which both hold the true distance, have no number in common.
/// Leaves out what the answers cost.
TradeResult compare_answers(std::span<const ClosestPoint> answers,
                            std::span<const ClosestPoint> exact);

/// Runs every action once in each of several rounds, so that all meet the same conditions. Returns
/// the median processor time of each, in seconds.
std::vector<double> median_seconds(std::span<const std::function<void()>> actions, int rounds);

}  // namespace planetree::tools
