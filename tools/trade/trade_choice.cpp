#include "tools/trade/trade_choice.h"

#include <algorithm>
#include <cmath>

namespace planetree::tools {
namespace {

bool promises(const TradeRow& row, double max_error) {
  const TradeSetting& setting = row.setting;
  if (setting.wait == Wait::kNever || setting.max_work != QueryOptions::kNoLimit ||
      setting.max_error > max_error)
    return false;
  return std::all_of(row.results.begin(), row.results.end(), [max_error](const TradeResult& r) {
    return r.broken == 0 && r.promised.most <= max_error;
  });
}

}  // namespace

double TradeRow::ratio_to_exact() const {
  double sum = 0;
  for (const TradeResult& result : results) sum += std::log(result.ratio_to_exact);
  return std::exp(sum / static_cast<double>(results.size()));
}

bool TradeRow::is_dominated_by(const TradeRow& other) const {
  bool less = false;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const TradeResult &own = results[i], &its = other.results[i];
    if (its.seconds > own.seconds || its.promised.p99 > own.promised.p99) return false;
    less = less || its.seconds < own.seconds || its.promised.p99 < own.promised.p99;
  }
  return less;
}

const TradeRow* choose(std::span<const TradeRow> rows, double max_error) {
  const TradeRow* best = nullptr;
  for (const TradeRow& row : rows) {
    if (!promises(row, max_error)) continue;
    if (!best || row.ratio_to_exact() < best->ratio_to_exact()) best = &row;
  }
  return best;
}

}  // namespace planetree::tools
