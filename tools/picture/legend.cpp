#include "tools/picture/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace planetree::tools {
namespace {

constexpr std::uint32_t kBarWidth = 24;
constexpr std::uint32_t kLineHeight = 20;
constexpr std::uint32_t kGap = 22;  // between bars and groups
constexpr double kTickSpace = 18;   // least distance of tick labels
constexpr double kLetter = 9;

// Draws the bands so that each begins and ends at a whole pixel.
void draw_bands(const ColourBar& bar, Drawing& drawing) {
  const double span = bar.upper() - bar.lower();
  const auto row_of = [&](double value) {
    return std::round(bar.top + bar.height * (bar.upper() - value) / span);
  };
  for (const ColourBand& band : bar.bands) {
    const double top = row_of(band.upper);
    drawing.shapes.emplace_back(FilledBox{static_cast<double>(bar.left), top,
                                          static_cast<double>(bar.width), row_of(band.lower) - top,
                                          band.colour});
  }
}

// Number of bands from tick to tick, so that labels do not touch.
double bands_per_tick(const ColourBar& bar) {
  const double band_height = bar.height / static_cast<double>(bar.bands.size());
  double step = 1;
  for (const double factor : {2.0, 5.0, 10.0, 20.0, 50.0})
    if (step * band_height < kTickSpace) step = factor;
  return step;
}

void draw_ticks(const ColourBar& bar, Drawing& drawing) {
  const double band = bar.bands.front().upper - bar.bands.front().lower;
  const double step = bands_per_tick(bar);
  const double right = bar.left + bar.width;
  Stroke ticks;
  const auto first = static_cast<std::int64_t>(std::ceil(std::round(bar.lower() / band) / step));
  const auto last = static_cast<std::int64_t>(std::floor(std::round(bar.upper() / band) / step));
  for (std::int64_t i = first; i <= last; ++i) {
    const double value = static_cast<double>(i) * step * band;
    const double y =
        std::round(bar.top + bar.height * (bar.upper() - value) / (bar.upper() - bar.lower()));
    ticks.paths.push_back({{right + 1, y}, {right + 6, y}});
    drawing.shapes.emplace_back(TextLine{{right + 10, y + 5}, value_text(value), kLetter});
  }
  drawing.shapes.emplace_back(std::move(ticks));
}

void draw_bar(const ColourBar& bar, Drawing& drawing) {
  const double left = bar.left;
  double y = bar.top - 10.0;
  if (!bar.above.empty()) {
    drawing.shapes.emplace_back(TextLine{{left, y}, bar.above, kLetter});
    y -= kLineHeight;
  }
  drawing.shapes.emplace_back(TextLine{{left, y}, bar.heading, kLetter});
  draw_bands(bar, drawing);
  const double right = left + bar.width, top = bar.top, bottom = top + bar.height;
  drawing.shapes.emplace_back(Stroke{{{{left - 0.5, top - 0.5},
                                       {right + 0.5, top - 0.5},
                                       {right + 0.5, bottom + 0.5},
                                       {left - 0.5, bottom + 0.5}}},
                                     true});
  draw_ticks(bar, drawing);
  if (!bar.below.empty())
    drawing.shapes.emplace_back(TextLine{{left, bottom + kLineHeight}, bar.below, kLetter});
}

void draw_entry(const LegendEntry& entry, double left, double y, Drawing& drawing) {
  if (entry.is_line)
    drawing.shapes.emplace_back(
        Stroke{{{{left + 1, y - 4}, {left + kBarWidth - 1.0, y - 4}}}, false, entry.colour, 2.5});
  else
    drawing.shapes.emplace_back(FilledBox{left, y - 11, kBarWidth, 13, entry.colour});
  drawing.shapes.emplace_back(TextLine{{left + kBarWidth + 10.0, y}, entry.text, kLetter});
}

}  // namespace

void Legend::place(std::uint32_t left, std::uint32_t top, std::uint32_t bar_height) {
  left_ = left;
  std::uint32_t y = top;
  for (ColourBar& bar : bars) {
    y += kLineHeight + (bar.above.empty() ? 0 : kLineHeight);
    bar.left = left;
    bar.top = y;
    bar.width = kBarWidth;
    bar.height = bar_height;
    y += bar.height + (bar.below.empty() ? 0 : kLineHeight) + kGap;
    bar_height = std::min<std::uint32_t>(bar_height, 120);
  }
  groups_top_ = y;
  for (const LegendGroup& group : groups)
    y += static_cast<std::uint32_t>(1 + group.entries.size()) * kLineHeight + kGap;
  bottom_ = y;
}

void Legend::draw(Drawing& drawing) const {
  for (const ColourBar& bar : bars) draw_bar(bar, drawing);
  double y = groups_top_;
  for (const LegendGroup& group : groups) {
    y += kLineHeight / 2.0;
    drawing.shapes.emplace_back(TextLine{{static_cast<double>(left_), y}, group.heading, kLetter});
    for (const LegendEntry& entry : group.entries) {
      y += kLineHeight;
      draw_entry(entry, left_, y, drawing);
    }
    y += kLineHeight / 2.0 + kGap;
  }
}

std::string value_text(double value) { return fmt::format("{:.6g}", value == 0 ? 0.0 : value); }

}  // namespace planetree::tools
