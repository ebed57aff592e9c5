#pragma once

#include <string>

#include "tools/trade/trade_record.h"

namespace planetree::tools {

/// The report as one HTML file: recommendations, then plots and a table a workload, then what
/// queries get that do not wait for pages.
///
/// command  what makes the page again, see trade_command()
std::string trade_page(const TradeRecord& record, const std::string& command);

}  // namespace planetree::tools
