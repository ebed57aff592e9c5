#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tools/trade/trade_run.h"
#include "tools/trade/trade_setting.h"

namespace planetree::tools {

/// The results of one setting, a result for each workload.
struct TradeRow {
  TradeSetting setting;
  std::vector<TradeResult> results;

  /// Mean cost over the workloads: the geometric mean of their ratios to exact answers.
  double ratio_to_exact() const;
  /// Whether another setting promises no more error for no more time in each workload, and less of
  /// one in some.
  bool is_dominated_by(const TradeRow& other) const;
};

/// Chooses the setting of least cost among those that keep an error at all points, also at others
/// than those measured: exact answers, and those of an allowed error of at most `max_error`. No
/// interval may be broken or wider. Null if there is none.
const TradeRow* choose(std::span<const TradeRow> rows, double max_error);

}  // namespace planetree::tools
