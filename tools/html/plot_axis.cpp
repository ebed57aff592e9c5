#include "tools/html/plot_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

constexpr double kLaneEnd = 0.2;
constexpr std::size_t kMinTicks = 4, kMaxTicks = 9;
/// Tolerance of comparisons with powers that rounding has moved.
constexpr double kSlack = 1e-9;

/// Ticks of a decade, from few to many.
const std::vector<std::vector<double>> kDecades = {
    {1}, {1, 3}, {1, 2, 5}, {1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8}};

/// Ticks from the greatest that is not above `lower` to the least that is not below `upper`.
std::vector<double> ticks_around(const std::vector<double>& decade, double lower, double upper) {
  std::vector<double> all;
  const int first = static_cast<int>(std::floor(std::log10(lower))) - 1;
  const int last = static_cast<int>(std::ceil(std::log10(upper))) + 1;
  for (int power = first; power <= last; ++power)
    for (const double digit : decade) all.push_back(digit * std::pow(10.0, power));
  auto begin = std::upper_bound(all.begin(), all.end(), lower * (1 + kSlack));
  auto end = std::lower_bound(all.begin(), all.end(), upper * (1 - kSlack));
  return {begin == all.begin() ? begin : begin - 1, end == all.end() ? end : end + 1};
}

/// The fewest ticks between two values that are enough.
std::vector<double> ticks_within(double lower, double upper) {
  std::vector<double> ticks;
  for (const auto& decade : kDecades) {
    ticks = ticks_around(decade, lower, upper);
    std::erase_if(ticks, [&](double tick) {
      return tick < lower * (1 - kSlack) || tick > upper * (1 + kSlack);
    });
    if (ticks.size() + 1 >= kMinTicks) break;
  }
  return ticks;
}

/// The narrowest range of ticks around the values, of neither too few nor too many.
std::vector<double> logarithmic_ticks(double lower, double upper) {
  // Points do not touch the ends.
  lower /= 1.03;
  upper *= 1.03;
  if (upper < 1.5 * lower) {
    lower /= 1.25;
    upper *= 1.25;
  }
  std::vector<double> best;
  for (const auto& decade : kDecades) {
    std::vector<double> ticks = ticks_around(decade, lower, upper);
    const bool is_better = best.empty() || best.size() < kMinTicks ||
                           (ticks.size() <= kMaxTicks &&
                            ticks.back() / ticks.front() < 0.99 * best.back() / best.front());
    if (is_better) best = std::move(ticks);
  }
  return best;
}

}  // namespace

PlotAxis PlotAxis::logarithmic(std::string title, std::span<const double> values, double least,
                               TickText text) {
  PlotAxis axis;
  axis.title_ = std::move(title);
  axis.is_logarithmic_ = true;
  axis.least_ = least;
  double lower = 0, upper = 0;
  for (const double value : values) {
    if (axis.is_in_lane(value)) {
      axis.lane_end_ = kLaneEnd;
    } else {
      lower = lower == 0 ? value : std::min(lower, value);
      upper = std::max(upper, value);
    }
  }
  if (lower == 0) lower = upper = least;
  std::vector<double> ticks = logarithmic_ticks(lower, upper);
  // What is below has a lane of its own.
  if (axis.lane_end_ > 0) std::erase_if(ticks, [&](double tick) { return axis.is_in_lane(tick); });
  axis.lower_ = std::log10(ticks.front());
  axis.upper_ = std::log10(ticks.back());
  if (axis.lane_end_ > 0) axis.ticks_.push_back({axis.place(0), "< " + text(least)});
  // Of very many decades, every other or fewer have room.
  const std::size_t step = (ticks.size() + kMaxTicks) / (kMaxTicks + 1);
  for (std::size_t i = (ticks.size() - 1) % step; i < ticks.size(); i += step)
    axis.add_tick(ticks[i], text(ticks[i]));
  return axis;
}

PlotAxis PlotAxis::linear(std::string title, double most, TickText text) {
  PlotAxis axis;
  axis.title_ = std::move(title);
  // The widest of 1, 2 and 5 times a power of ten that makes enough ticks.
  const double span = most > 0 ? most : 1;
  double step = std::pow(10.0, std::floor(std::log10(span)));
  for (const double part : {0.5, 0.2, 0.1}) {
    if (span / step >= kMinTicks - 1) break;
    step = part * std::pow(10.0, std::floor(std::log10(span)));
  }
  const int ticks = static_cast<int>(std::ceil(span / step * (1 - kSlack)));
  axis.upper_ = ticks * step;
  for (int tick = 0; tick <= ticks; ++tick) axis.add_tick(tick * step, text(tick * step));
  return axis;
}

PlotAxis PlotAxis::between(std::string title, double lower, double upper, TickText text) {
  constexpr double kMaxTicksBetween = 7;
  PlotAxis axis;
  axis.title_ = std::move(title);
  axis.lower_ = lower;
  axis.upper_ = upper;
  double step = std::pow(10.0, std::floor(std::log10((upper - lower) / kMaxTicksBetween)));
  for (const double factor : {2.0, 2.5, 2.0, 2.0}) {
    if (std::floor((upper - lower) / step) + 1 <= kMaxTicksBetween) break;
    step *= factor;
  }
  const double slack = kSlack * step;
  for (double n = std::ceil((lower - slack) / step); n * step <= upper + slack; ++n)
    axis.add_tick(n * step + 0.0, text(n * step + 0.0));  // no -0
  return axis;
}

PlotAxis PlotAxis::quantiles(std::string title, double most) {
  constexpr int kMaxNines = 5;
  PlotAxis axis;
  axis.title_ = std::move(title);
  axis.is_logarithmic_ = true;
  constexpr double kMargin = 0.05;  // for the text of the first and the last tick
  const double powers = std::log10(std::max(most, 10.0));
  axis.lower_ = -kMargin * powers;
  axis.upper_ = (1 + kMargin) * powers;
  const int nines = static_cast<int>(powers + kSlack);
  const int step = (nines + kMaxNines - 1) / kMaxNines;
  axis.add_tick(1, "min");
  if (nines < kMaxNines) axis.add_tick(2, "50 %");
  for (int power = step; power <= nines; power += step) {
    std::string text(power > 2 ? static_cast<std::size_t>(power) - 2 : 0, '9');
    axis.add_tick(std::pow(10.0, power),
                  power == 1 ? "90 %" : "99" + (power > 2 ? "." + text : "") + " %");
  }
  return axis;
}

PlotAxis PlotAxis::percent(std::string title) {
  PlotAxis axis;
  axis.title_ = std::move(title);
  for (const int percent : {0, 25, 50, 75, 100})
    axis.add_tick(percent / 100.0, fmt::format("{} %", percent));
  return axis;
}

PlotAxis PlotAxis::named(std::string title, const std::vector<std::string>& names) {
  PlotAxis axis;
  axis.title_ = std::move(title);
  axis.lower_ = -0.5;
  axis.upper_ = static_cast<double>(names.size()) - 0.5;
  for (std::size_t i = 0; i < names.size(); ++i) axis.add_tick(static_cast<double>(i), names[i]);
  return axis;
}

PlotAxis PlotAxis::in_units_of(double unit, std::string title, TickText text) const {
  PlotAxis axis = *this;
  axis.title_ = std::move(title);
  axis.ticks_.clear();
  axis.least_ = least_ / unit;
  axis.lower_ = lower_ - std::log10(unit);
  axis.upper_ = upper_ - std::log10(unit);
  for (const double tick : ticks_within(std::pow(10.0, axis.lower_), std::pow(10.0, axis.upper_)))
    axis.add_tick(tick, text(tick));
  return axis;
}

bool PlotAxis::is_in_lane(double value) const { return is_logarithmic_ && value < least_; }

double PlotAxis::place(double value) const {
  if (is_in_lane(value)) return lane_end_ / 2;
  const double at = is_logarithmic_ ? std::log10(value) : value;
  return lane_end_ + (1 - lane_end_) * (at - lower_) / (upper_ - lower_);
}

void PlotAxis::add_tick(double value, std::string text) {
  const double at = is_logarithmic_ ? std::log10(value) : value;
  ticks_.push_back(
      {lane_end_ + (1 - lane_end_) * (at - lower_) / (upper_ - lower_), std::move(text)});
}

}  // namespace planetree::tools
