#include "tools/html/plot_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace planetree::tools {
namespace {

constexpr double kWidth = 480, kHeight = 330;
constexpr double kLeft = 58, kRight = 18, kTop = 32, kTopWithUpperAxis = 46, kBottom = 46;

/// Sizes of the text of narrow and of wide pages, see the page's style.
struct TextSize {
  double height, character;
  bool is_for_wide_pages;
};
constexpr TextSize kNarrowText{16, 8.6, false};
constexpr TextSize kWideText{12, 6.4, true};

PlotRect around(const PlotPlace& place) {
  return {place.x - kPlotShapeReach, place.y - kPlotShapeReach, place.x + kPlotShapeReach,
          place.y + kPlotShapeReach};
}

/// Numbers of points, those that are not muted first, then from the top.
std::vector<std::size_t> by_importance(const SvgPlot& plot, const PlotLayout& layout) {
  std::vector<std::size_t> order(plot.points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (plot.points[a].is_muted != plot.points[b].is_muted) return plot.points[b].is_muted;
    return layout.points[a].y < layout.points[b].y;
  });
  return order;
}

/// Moves points of the lane sideways until they do not cover each other, as far as it is wide.
void spread_lane(const SvgPlot& plot, PlotLayout& layout) {
  constexpr double kStep = 2 * kPlotShapeReach + 0.5;
  std::vector<PlotRect> taken;
  for (const std::size_t i : by_importance(plot, layout)) {
    if (!plot.x.is_in_lane(plot.points[i].x)) continue;
    const PlotPlace middle = layout.points[i];
    for (const double steps : {0, 1, -1, 2, -2}) {
      const PlotRect rect = around({middle.x + steps * kStep, middle.y});
      if (std::any_of(taken.begin(), taken.end(),
                      [&](const PlotRect& other) { return rect.overlaps(other); }))
        continue;
      layout.points[i].x = middle.x + steps * kStep;
      break;
    }
    taken.push_back(around(layout.points[i]));
  }
}

/// A place of a label beside its point: corner of the text's rectangle and its anchor.
struct Candidate {
  double right, down;  ///< shares of the text's size by which its rectangle is moved
  double x, y;         ///< from the point to that corner
  const char* anchor;
};
constexpr double kGap = kPlotShapeReach + 2;
constexpr std::array<Candidate, 6> kCandidates{{{0, -0.5, kGap, 0, "start"},
                                                {0, -1, 4, -kGap + 1, "start"},
                                                {-1, -0.5, -kGap, 0, "end"},
                                                {-1, -1, -4, -kGap + 1, "end"},
                                                {0, 0, 4, kGap - 1, "start"},
                                                {-1, 0, -4, kGap - 1, "end"}}};

class LabelPlacer {
 public:
  LabelPlacer(const SvgPlot& plot, PlotLayout& layout) : plot_(plot), layout_(layout) {
    for (const PlotPlace& place : layout.points) taken_.push_back(around(place));
    done_.resize(layout.points.size());
  }
  void place_all(const TextSize& size) {
    for (const std::size_t i : by_importance(plot_, layout_))
      if (!done_[i] && !plot_.points[i].label.empty()) done_[i] = place(i, size);
  }

 private:
  bool place(std::size_t i, const TextSize& size) {
    const double width = size.character * static_cast<double>(plot_.points[i].label.size());
    const PlotPlace& at = layout_.points[i];
    for (const Candidate& c : kCandidates) {
      const double left = at.x + c.x + c.right * width, top = at.y + c.y + c.down * size.height;
      const PlotRect rect{left, top, left + width, top + size.height};
      if (!layout_.frame.contains(rect)) continue;
      if (std::any_of(taken_.begin(), taken_.end(),
                      [&](const PlotRect& other) { return rect.overlaps(other); }))
        continue;
      taken_.push_back(rect);
      layout_.labels.push_back(
          {i, at.x + c.x, top + 0.77 * size.height, c.anchor, size.is_for_wide_pages});
      return true;
    }
    return false;
  }

  const SvgPlot& plot_;
  PlotLayout& layout_;
  std::vector<PlotRect> taken_;
  std::vector<bool> done_;
};

}  // namespace

PlotLayout lay_out(const SvgPlot& plot) {
  PlotLayout layout;
  layout.width = kWidth;
  layout.height = kHeight;
  layout.frame = {kLeft, plot.upper_x ? kTopWithUpperAxis : kTop, kWidth - kRight,
                  kHeight - kBottom};
  for (const PlotPoint& point : plot.points)
    layout.points.push_back(
        {layout.x_of(plot.x.place(point.x)) + point.shift, layout.y_of(plot.y.place(point.y))});
  spread_lane(plot, layout);
  LabelPlacer placer(plot, layout);
  placer.place_all(kNarrowText);
  placer.place_all(kWideText);
  return layout;
}

}  // namespace planetree::tools
