#include "tools/trade/trade_setting.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace planetree::tools {

namespace {

/// Rounds an error down to three digits, so that the option is short.
double short_error(double error) { return std::stod(fmt::format("{:.2e}", 0.995 * error)); }

}  // namespace

std::string TradeSetting::options() const {
  std::string text;
  const auto add = [&text](const std::string& option) {
    text += (text.empty() ? "" : " ") + option;
  };
  if (max_error > 0) add(fmt::format("--max-error {}", max_error));
  if (max_work != QueryOptions::kNoLimit) add(fmt::format("--max-work {}", max_work));
  if (wait == Wait::kNever) add(fmt::format("--never-wait --memory {}", memory_bytes));
  return text;
}

std::vector<TradeSetting> trade_settings(double diagonal, double median_edge,
                                         std::uint64_t memory_bytes, std::uint64_t whole_bytes) {
  TradeSetting exact;
  exact.memory_bytes = memory_bytes;
  std::vector<TradeSetting> settings{exact};
  std::vector<double> errors;
  for (const double share : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1})
    errors.push_back(short_error(share * diagonal));
  if (median_edge > 0) {
    errors.push_back(short_error(median_edge));
    errors.push_back(short_error(10 * median_edge));
  }
  std::sort(errors.begin(), errors.end());
  for (const double error : errors) {
    settings.push_back(exact);
    settings.back().max_error = error;
  }
  for (std::uint32_t work = 8; work <= 512; work *= 2) {
    settings.push_back(exact);
    settings.back().max_work = work;
  }
  for (const double share : {0.05, 0.25, 1.0}) {
    settings.push_back(exact);
    settings.back().wait = Wait::kNever;
    settings.back().memory_bytes =
        static_cast<std::uint64_t>(share * static_cast<double>(whole_bytes));
  }
  return settings;
}

}  // namespace planetree::tools
