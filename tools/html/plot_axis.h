#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace planetree::tools {

/// A mark on an axis.
struct PlotTick {
  double place = 0;  ///< share of the axis, 0 to 1
  std::string text;
};

/// An axis of a plot: where values lie on it, and its ticks.
class PlotAxis {
 public:
  /// The text of a tick.
  using TickText = std::function<std::string(double)>;

  /// A logarithmic axis that begins and ends at ticks around the values. Values below `least`, zero
  /// among them, have no place on it: they lie in a lane of their own before it. There is a lane if
  /// there is such a value.
  ///
  /// values  finite and >= 0
  /// least   > 0
  static PlotAxis logarithmic(std::string title, std::span<const double> values, double least,
                              TickText text);
  /// From 0 to a tick that is not below `most`.
  ///
  /// most  finite and >= 0
  static PlotAxis linear(std::string title, double most, TickText text);
  /// From one value to another, with ticks at round values between them.
  ///
  /// lower, upper  finite, lower < upper
  static PlotAxis between(std::string title, double lower, double upper, TickText text);
  /// Of quantiles, with equal room for each nine: value n is the quantile that one in n values
  /// exceeds, so that 1 is the least, 2 the median and 100 the 99 % quantile.
  ///
  /// most  number of measured values, 1 or more
  static PlotAxis quantiles(std::string title, double most);
  /// From 0 to 1, with ticks in percent.
  static PlotAxis percent(std::string title);
  /// Ticks at the values 0, 1, 2 and so on. There is at least one.
  static PlotAxis named(std::string title, const std::vector<std::string>& names);

  /// The same logarithmic axis with the ticks of another unit, between its ends.
  PlotAxis in_units_of(double unit, std::string title, TickText text) const;

  const std::string& title() const { return title_; }
  const std::vector<PlotTick>& ticks() const { return ticks_; }
  /// Whether a value lies in the lane.
  bool is_in_lane(double value) const;
  /// Where the lane ends, as a share of the axis; 0 if there is none.
  double lane_end() const { return lane_end_; }
  /// Share of the axis at which a value lies.
  double place(double value) const;

 private:
  void add_tick(double value, std::string text);

  std::string title_;
  std::vector<PlotTick> ticks_;
  bool is_logarithmic_ = false;
  double least_ = 0;
  double lane_end_ = 0;
  double lower_ = 0, upper_ = 1;  // at lane_end_ and at 1; logarithms if logarithmic
};

}  // namespace planetree::tools
