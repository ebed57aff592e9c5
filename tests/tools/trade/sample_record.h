#pragma once

#include <string>

#include "tools/trade/trade_record.h"

namespace planetree::tools {

/// Measurements that nobody made, of a file of that name: exact answers, seven errors, seven limits
/// of work, and two budgets without waiting, for uniform, near and path points. Near the surface
/// only limits of work are not exact, as is usual.
TradeRecord sample_record(const std::string& file);

}  // namespace planetree::tools
