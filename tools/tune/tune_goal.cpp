#include "tools/tune/tune_goal.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

constexpr std::pair<TuneGoal::Quantity, const char*> kNames[] = {
    {TuneGoal::Quantity::kDegraded, "degraded"},
    {TuneGoal::Quantity::kWidth, "width"},
    {TuneGoal::Quantity::kTicksToExact, "ticks"},
    {TuneGoal::Quantity::kMisses, "misses"}};

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

Error not_a_goal(std::string_view text) {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "\"%.60s\" is no goal; give degraded<0.1%%, width<W, ticks<N or misses<M with "
                    "a limit above 0",
                    std::string(text).c_str());
}

}  // namespace

Result<TuneGoal> TuneGoal::parse(std::string_view text) {
  const std::size_t sign = text.find('<');
  if (sign == std::string_view::npos) return not_a_goal(text);
  const std::string_view name = trimmed(text.substr(0, sign));
  std::string_view value = trimmed(text.substr(sign + 1));
  const bool is_percent = !value.empty() && value.back() == '%';
  if (is_percent) value = trimmed(value.substr(0, value.size() - 1));
  TuneGoal goal;
  const auto [end, failed] = std::from_chars(value.data(), value.data() + value.size(), goal.limit);
  if (failed != std::errc() || end != value.data() + value.size() || !std::isfinite(goal.limit) ||
      goal.limit <= 0)
    return not_a_goal(text);
  for (const auto& [quantity, known] : kNames) {
    if (name != known) continue;
    if (is_percent && quantity != Quantity::kDegraded) return not_a_goal(text);
    if (is_percent) goal.limit /= 100;
    goal.quantity = quantity;
    return goal;
  }
  return not_a_goal(text);
}

const char* name_of(TuneGoal::Quantity quantity) noexcept {
  for (const auto& [known, name] : kNames)
    if (known == quantity) return name;
  return "";
}

std::string text_of(TuneGoal::Quantity quantity, double value) {
  if (quantity == TuneGoal::Quantity::kDegraded) return number_text(100 * value) + " %";
  if (quantity == TuneGoal::Quantity::kTicksToExact) return fmt::format("{:.0f}", value);
  return number_text(value);
}

}  // namespace planetree::tools
