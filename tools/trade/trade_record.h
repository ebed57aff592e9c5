#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "planetree/layers.h"

#include "tools/trade/trade_choice.h"
#include "tools/trade/trade_points.h"

namespace planetree::tools {

/// All measurements of one model.
struct TradeRecord {
  std::string file;
  std::uint64_t triangles = 0;
  double diagonal = 0;                     ///< of the core, model units
  double median_edge = 0;                  ///< model units; 0 if it is not known
  std::uint64_t whole_bytes = 0;           ///< memory that holds the whole model
  std::uint32_t file_layers = kAllLayers;  ///< layers of the file
  std::uint32_t layers = kAllLayers;       ///< layers that are open
  std::uint32_t parts = kAllParts;         ///< parts that they tell
  std::vector<TradeWorkload> workloads;
  std::vector<TradeRow> rows;            ///< exact answers first
  std::vector<std::uint64_t> too_small;  ///< budgets that the model does not fit, bytes

  /// A length as a share of the diagonal.
  double share(double length) const { return length / diagonal; }
};

/// An error that a user may ask for.
struct TradeGoal {
  double max_error = 0;  ///< model units
  std::string name;      ///< such as "1e-3 of the diagonal"
};
/// The errors that the report recommends settings for: shares of the diagonal, and the median edge.
std::vector<TradeGoal> trade_goals(const TradeRecord& record);

/// A setting's name in reports: what it allows, errors as shares of the diagonal.
std::string name_of(const TradeSetting& setting, double diagonal);

double per_second(const TradeResult& result);
double pages_per_query(const TradeResult& result);

/// Figures of a row over all workloads.
struct TradeOverall {
  double actual_p99 = 0;  ///< the largest 99 % quantile of the true error, model units
  std::size_t broken = 0, points = 0;
};
TradeOverall overall(const TradeRow& row);

}  // namespace planetree::tools
