#include "tests/tools/trade/sample_record.h"

#include <algorithm>
#include <cmath>

namespace planetree::tools {
namespace {

constexpr std::size_t kPoints = 2000;

/// A result whose promised error is at most `share` of the diagonal.
TradeResult result_of(const TradeRecord& record, double share, double seconds) {
  TradeResult result;
  const double width = share * record.diagonal;
  result.points = kPoints;
  result.seconds = seconds;
  result.ratio_to_exact = seconds / 0.002;
  result.pages = 124;
  result.promised = {width / 3, 0.97 * width, width};
  if (share > 1e-9) result.actual = {0, width / 4, width / 2};
  result.exact = share > 1e-9 ? kPoints / 10 : kPoints;
  return result;
}

TradeRow row_of(const TradeRecord& record, const TradeSetting& setting, double share,
                double seconds) {
  TradeRow row{setting, {}};
  for (std::size_t i = 0; i < record.workloads.size(); ++i) {
    const bool is_exact = i > 0 && setting.wait == Wait::kForPages &&
                          (setting.max_work == QueryOptions::kNoLimit || setting.max_work > 16);
    row.results.push_back(
        result_of(record, is_exact ? 4e-17 : share, seconds / (1 + static_cast<double>(i))));
    if (setting.wait == Wait::kNever || setting.max_work <= 32)
      row.results.back().degraded = kPoints / (2 + 3 * i);
  }
  return row;
}

}  // namespace

TradeRecord sample_record(const std::string& file) {
  TradeRecord record;
  record.file = file;
  record.triangles = 299568;
  record.diagonal = 380.633;
  record.median_edge = 1.19;
  record.whole_bytes = 8 << 20;
  record.workloads = {kMadeWorkloads.begin(), kMadeWorkloads.end()};
  record.too_small = {400 << 10};
  for (const TradeSetting& setting :
       trade_settings(record.diagonal, record.median_edge, 256 << 20, record.whole_bytes)) {
    double share = 3.7e-15, seconds = 0.002;
    if (setting.max_error > 0) {
      share = std::min(setting.max_error / record.diagonal, 9.1e-3);
      seconds = 0.0016 + 1e-4 / (1 + 1000 * share);
    } else if (setting.max_work != QueryOptions::kNoLimit) {
      share = setting.max_work > 64 ? 3.8e-15 : 1.0 / (setting.max_work * setting.max_work);
      seconds = setting.max_work == 8 ? 0.001 : 0.0021;
    } else if (setting.wait == Wait::kNever) {
      if (setting.memory_bytes < (1 << 20)) continue;
      share = setting.memory_bytes < record.whole_bytes ? 0.21 : 1e-4;
      seconds = 0.01;
    }
    record.rows.push_back(row_of(record, setting, share, seconds));
  }
  return record;
}

}  // namespace planetree::tools
