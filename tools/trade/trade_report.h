#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/trade/trade_choice.h"
#include "tools/trade/trade_points.h"

namespace planetree::tools {

/// All measurements of one model.
struct TradeRecord {
  std::string file;
  std::uint64_t triangles = 0;
  double diagonal = 0;     ///< of the core, model units
  double median_edge = 0;  ///< model units; 0 if it is not known
  std::vector<TradeWorkload> workloads;
  std::vector<TradeRow> rows;            ///< exact answers first
  std::vector<std::uint64_t> too_small;  ///< budgets that the model does not fit, bytes
};

/// An error that a user may ask for.
struct TradeGoal {
  double max_error = 0;  ///< model units
  std::string name;      ///< such as "1e-3 of the diagonal"
};
/// The errors that the report recommends settings for: shares of the diagonal, and the median edge.
std::vector<TradeGoal> trade_goals(const TradeRecord& record);

/// The report for people: a table a workload, then a recommendation for each goal.
std::string trade_words(const TradeRecord& record);
/// The report as one JSON object.
std::string trade_json(const TradeRecord& record);

}  // namespace planetree::tools
