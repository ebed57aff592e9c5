#pragma once

#include "tools/html/svg_plot.h"
#include "tools/trade/trade_record.h"

/// The plots of a trade's page. Points carry key_of() their settings.
namespace planetree::tools {

/// Queries a second against the promised error of a workload, of the settings that wait for pages.
/// Steps join the settings that no other dominates.
SvgPlot rate_plot(const TradeRecord& record, std::size_t workload);
/// Pages a query against the promised error.
SvgPlot pages_plot(const TradeRecord& record, std::size_t workload);

/// Promised error within each memory budget of the settings that do not wait, by workload: the
/// median and the 99 % quantile.
SvgPlot width_plot(const TradeRecord& record);
/// Share of their answers that are degraded.
SvgPlot degraded_plot(const TradeRecord& record);

}  // namespace planetree::tools
