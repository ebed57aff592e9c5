#include "tools/trade/trade_record.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/size_text.h"
#include "tools/html/html_text.h"

namespace planetree::tools {

std::vector<TradeGoal> trade_goals(const TradeRecord& record) {
  std::vector<TradeGoal> goals;
  for (const double share : {1e-4, 1e-3, 1e-2})
    goals.push_back(
        {share * record.diagonal, fmt::format("{} of the diagonal", short_power_text(share))});
  if (record.median_edge > 0) goals.push_back({record.median_edge, "the median edge"});
  return goals;
}

std::string name_of(const TradeSetting& setting, double diagonal) {
  if (setting.max_error > 0) return "error " + short_power_text(setting.max_error / diagonal);
  if (setting.max_work != QueryOptions::kNoLimit) return fmt::format("work {}", setting.max_work);
  if (setting.wait == Wait::kNever)
    return fmt::format("no wait, {}", short_bytes(setting.memory_bytes));
  return "exact";
}

double per_second(const TradeResult& result) {
  return result.seconds > 0 ? static_cast<double>(result.points) / result.seconds : 0;
}

double pages_per_query(const TradeResult& result) {
  return static_cast<double>(result.pages) / static_cast<double>(result.points);
}

TradeOverall overall(const TradeRow& row) {
  TradeOverall all;
  for (const TradeResult& result : row.results) {
    all.actual_p99 = std::max(all.actual_p99, result.actual.p99);
    all.broken += result.broken;
    all.points += result.points;
  }
  return all;
}

}  // namespace planetree::tools
