#pragma once

#include <string>

#include "tools/trade/trade_record.h"

namespace planetree::tools {

/// The report for people: a table a workload, then a recommendation for each goal.
std::string trade_words(const TradeRecord& record);
/// The report as one JSON object.
std::string trade_json(const TradeRecord& record);

}  // namespace planetree::tools
