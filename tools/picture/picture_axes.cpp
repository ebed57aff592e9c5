#include "tools/picture/picture_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tools/picture/band_scale.h"
#include "tools/picture/legend.h"
#include "tools/picture/stroke_font.h"

namespace planetree::tools {
namespace {

constexpr double kLetter = 9;
constexpr double kTickLength = 6;
constexpr double kMaxBarShare = 0.25;  // of the raster's width
constexpr double kMinBarPixels = 24;

/// Coordinates of ticks: multiples of a round length from `lower` to `upper`.
struct AxisTicks {
  double step = 1;
  std::int64_t first = 0, last = -1;

  AxisTicks(double lower, double upper, double least_step) {
    step = round_length(least_step);
    if (step < least_step) step = round_length(step * 2.5);
    if (step < least_step) step = round_length(step * 2.5);
    // Beyond 2^53 steps from the origin, ticks would not differ.
    const double limit = 9007199254740992.0 * step;
    if (!(std::isnormal(step) && std::fabs(lower) < limit && std::fabs(upper) < limit)) return;
    first = static_cast<std::int64_t>(std::ceil(lower / step));
    last = static_cast<std::int64_t>(std::floor(upper / step));
  }
};

// A coordinate with the digits that tell it from the next tick.
std::string tick_text(double value, double step) {
  int digits = 6;
  for (double steps = std::fabs(value) / step; steps >= 1e5 && digits < 17; steps /= 10) ++digits;
  return fmt::format("{:.{}g}", value == 0 ? 0.0 : value, digits);
}

// Least distance of ticks: the width of the longest label, for an axis across.
double label_pixels(double lower, double upper, double pixel_length) {
  constexpr double kMinPixels = 60;
  const double step = kMinPixels * pixel_length;
  const double longest = std::max(text_length(tick_text(lower, step), kLetter),
                                  text_length(tick_text(upper, step), kLetter));
  return std::max(kMinPixels, longest + 16);
}

AxisTicks up_ticks(const RasterFrame& frame) {
  constexpr double kMinPixels = 40;
  return {frame.top_coordinate - frame.pixel_length * frame.height, frame.top_coordinate,
          kMinPixels * frame.pixel_length};
}

void draw_right_axis(const RasterFrame& frame, Drawing& drawing) {
  const double upper = frame.left_coordinate + frame.pixel_length * frame.width;
  const double bottom = frame.top + frame.height;
  const AxisTicks ticks(
      frame.left_coordinate, upper,
      label_pixels(frame.left_coordinate, upper, frame.pixel_length) * frame.pixel_length);
  Stroke marks;
  for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
    const double value = static_cast<double>(i) * ticks.step;
    const double x = std::round(frame.left + (value - frame.left_coordinate) / frame.pixel_length);
    marks.paths.push_back({{x, bottom + 1}, {x, bottom + kTickLength}});
    drawing.shapes.emplace_back(
        TextLine{{x, bottom + 22}, tick_text(value, ticks.step), kLetter, Anchor::kMiddle});
  }
  drawing.shapes.emplace_back(std::move(marks));
  drawing.shapes.emplace_back(TextLine{{frame.left + frame.width / 2.0, bottom + 44},
                                       std::string(1, frame.right_axis),
                                       10,
                                       Anchor::kMiddle});
}

void draw_up_axis(const RasterFrame& frame, Drawing& drawing) {
  const AxisTicks ticks = up_ticks(frame);
  Stroke marks;
  const double left = frame.left;
  for (std::int64_t i = ticks.first; i <= ticks.last; ++i) {
    const double value = static_cast<double>(i) * ticks.step;
    const double y = std::round(frame.top + (frame.top_coordinate - value) / frame.pixel_length);
    marks.paths.push_back({{left - kTickLength, y}, {left - 1, y}});
    drawing.shapes.emplace_back(
        TextLine{{left - 10, y + 5}, tick_text(value, ticks.step), kLetter, Anchor::kEnd});
  }
  drawing.shapes.emplace_back(std::move(marks));
  drawing.shapes.emplace_back(TextLine{{18, frame.top + frame.height / 2.0 + 5},
                                       std::string(1, frame.up_axis),
                                       10,
                                       Anchor::kMiddle});
}

void draw_scale_bar(const RasterFrame& frame, Drawing& drawing) {
  const double most = std::max(frame.width * kMaxBarShare, kMinBarPixels);
  const double length = round_length(most * frame.pixel_length);
  const double pixels = length / frame.pixel_length;
  const double y = frame.top + frame.height + 66.0, left = frame.left;
  drawing.shapes.emplace_back(Stroke{{{{left, y - 5}, {left, y + 5}},
                                      {{left, y}, {left + pixels, y}},
                                      {{left + pixels, y - 5}, {left + pixels, y + 5}}},
                                     false,
                                     kInk,
                                     2});
  drawing.shapes.emplace_back(TextLine{
      {left + pixels + 12, y + 5}, fmt::format("{} model units", value_text(length)), kLetter});
}

}  // namespace

std::uint32_t left_room(const RasterFrame& frame) {
  constexpr std::uint32_t kMinRoom = 86;
  constexpr double kBeside = 46;  // tick, gaps and the axis's name
  const AxisTicks ticks = up_ticks(frame);
  double longest = 0;
  for (std::int64_t i = ticks.first; i <= ticks.last; ++i)
    longest = std::max(
        longest, text_length(tick_text(static_cast<double>(i) * ticks.step, ticks.step), kLetter));
  return std::max(kMinRoom, static_cast<std::uint32_t>(longest + kBeside));
}

void draw_axes(const RasterFrame& frame, Drawing& drawing) {
  const double left = frame.left - 0.5, top = frame.top - 0.5;
  const double right = frame.left + frame.width + 0.5, bottom = frame.top + frame.height + 0.5;
  drawing.shapes.emplace_back(
      Stroke{{{{left, top}, {right, top}, {right, bottom}, {left, bottom}}}, true});
  draw_right_axis(frame, drawing);
  draw_up_axis(frame, drawing);
  draw_scale_bar(frame, drawing);
}

}  // namespace planetree::tools
