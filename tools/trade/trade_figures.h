#pragma once

#include <string>
#include <vector>

#include "tools/html/html_page.h"
#include "tools/html/html_table.h"
#include "tools/trade/trade_record.h"

/// The figures of a setting's answers, named and written in one way for tables and plots.
namespace planetree::tools {

/// A figure: its column in a table, and its text.
struct TradeFigure {
  HtmlColumn column;
  std::string text;
};

/// Errors below this share of the diagonal count as none: they are the rounding of doubles.
inline constexpr double kTradeMinShare = 1e-9;

/// Whether another setting that waits for pages is at least as good in this workload, by time and
/// by the 99 % quantile of the promised error, and better in one of them.
bool is_dominated(const TradeRecord& record, const TradeRow& row, std::size_t workload);

/// Names a setting's answers to a workload in the page.
std::string key_of(const TradeRecord& record, const TradeRow& row, std::size_t workload);

/// All figures of a setting's answers to a workload. The same columns for all settings.
std::vector<TradeFigure> trade_figures(const TradeRecord& record, const TradeRow& row,
                                       std::size_t workload);

/// The figures with the setting as title, for HtmlPage::figures.
HtmlFigures named_figures(const TradeRecord& record, const TradeRow& row, std::size_t workload);

}  // namespace planetree::tools
