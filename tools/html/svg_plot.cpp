#include "tools/html/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "tools/html/html_text.h"
#include "tools/html/plot_figure.h"
#include "tools/html/plot_layout.h"

namespace planetree::tools {
namespace {

/// Appends the parts of a plot's drawing.
class Drawing {
 public:
  explicit Drawing(const SvgPlot& plot) : plot_(plot), layout_(lay_out(plot)) {}

  std::string html() {
    text_ = svg_begin({plot_.id, plot_.title, plot_.description, layout_.width, layout_.height});
    add_lanes();
    add_x_axis();
    add_upper_x_axis();
    add_y_axis();
    const PlotRect& frame = layout_.frame;
    add(R"(<path class="frame" d="M{:.1f} {:.1f}V{:.1f}H{:.1f}"/>)"
        "\n",
        frame.left, frame.top, frame.bottom, frame.right);
    if (plot_.has_steps) add_steps();
    if (plot_.has_lines) add_lines();
    add_points();
    add_labels();
    return text_ + "</svg>\n";
  }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }

  /// A band for the lane of each axis, with a gap to the axis proper.
  void add_lanes() {
    constexpr double kGap = 6;
    PlotRect x_lane = layout_.frame, y_lane = layout_.frame;
    x_lane.right = layout_.x_of(plot_.x.lane_end()) - kGap;
    y_lane.top = layout_.y_of(plot_.y.lane_end()) + kGap;
    if (plot_.x.lane_end() > 0) add_lane(x_lane);
    if (plot_.y.lane_end() > 0) add_lane(y_lane);
  }

  void add_lane(const PlotRect& lane) {
    add(R"(<rect class="lane" x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}"/>)"
        "\n",
        lane.left, lane.top, lane.right - lane.left, lane.bottom - lane.top);
  }

  void add_x_axis() {
    const PlotRect& frame = layout_.frame;
    for (std::size_t i = 0; i < plot_.x.ticks().size(); ++i) {
      const PlotTick& tick = plot_.x.ticks()[i];
      const double x = layout_.x_of(tick.place);
      if (tick.place >= plot_.x.lane_end())
        add(R"(<path class="grid" d="M{:.1f} {:.1f}V{:.1f}"/>)", x, frame.top, frame.bottom);
      add(R"(<text class="{}" x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)"
          "\n",
          tick_class(plot_.x, i), x, frame.bottom + 16, html_text(tick.text));
    }
    add(R"(<text class="title" x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)"
        "\n",
        (frame.left + frame.right) / 2, layout_.height - 8, html_text(plot_.x.title()));
  }

  void add_upper_x_axis() {
    if (!plot_.upper_x) return;
    const PlotRect& frame = layout_.frame;
    for (std::size_t i = 0; i < plot_.upper_x->ticks().size(); ++i) {
      const PlotTick& tick = plot_.upper_x->ticks()[i];
      const double x = layout_.x_of(tick.place);
      add(R"(<path class="mark" d="M{:.1f} {:.1f}v-5"/>)", x, frame.top);
      add(R"(<text class="{}" x="{:.1f}" y="{:.1f}" text-anchor="middle">{}</text>)"
          "\n",
          tick_class(*plot_.upper_x, i), x, frame.top - 9, html_text(tick.text));
    }
    add(R"(<text class="title" x="{:.1f}" y="14" text-anchor="end">{}</text>)"
        "\n",
        frame.right, html_text(plot_.upper_x->title()));
  }

  void add_y_axis() {
    const PlotRect& frame = layout_.frame;
    for (const PlotTick& tick : plot_.y.ticks()) {
      const double y = layout_.y_of(tick.place);
      if (tick.place >= plot_.y.lane_end())
        add(R"(<path class="grid" d="M{:.1f} {:.1f}H{:.1f}"/>)", frame.left, y, frame.right);
      add(R"(<text class="tick" x="{:.1f}" y="{:.1f}" text-anchor="end">{}</text>)"
          "\n",
          frame.left - 8, y + 4, html_text(tick.text));
    }
    add(R"(<text class="title" x="4" y="14">{}</text>)"
        "\n",
        html_text(plot_.y.title()));
  }

  /// To the right of a point that is not muted, nothing is better until the next.
  void add_steps() {
    std::vector<std::size_t> joined;
    for (std::size_t i = 0; i < plot_.points.size(); ++i)
      if (!plot_.points[i].is_muted) joined.push_back(i);
    if (joined.empty()) return;
    std::stable_sort(joined.begin(), joined.end(), [&](std::size_t a, std::size_t b) {
      return plot_.points[a].x < plot_.points[b].x ||
             (plot_.points[a].x == plot_.points[b].x && plot_.points[a].y < plot_.points[b].y);
    });
    add(R"(<path class="steps" d="M{:.1f} {:.1f})", layout_.points[joined[0]].x,
        layout_.points[joined[0]].y);
    for (std::size_t k = 1; k < joined.size(); ++k)
      add("H{:.1f}V{:.1f}", layout_.points[joined[k]].x, layout_.points[joined[k]].y);
    add(R"(H{:.1f}"/>)"
        "\n",
        layout_.frame.right);
  }

  void add_lines() {
    for (std::size_t series = 0; series < plot_.series.size(); ++series) {
      char command = 'M';
      for (std::size_t i = 0; i < plot_.points.size(); ++i) {
        if (plot_.points[i].series != series) continue;
        if (command == 'M') add(R"(<path class="line c{}" d=")", series % kPlotColours);
        add("{}{:.1f} {:.1f}", command, layout_.points[i].x, layout_.points[i].y);
        command = 'L';
      }
      if (command == 'L') text_ += "\"/>\n";
    }
  }

  /// Those that are not muted come last, on top of the others.
  void add_points() {
    for (const bool is_muted : {true, false})
      for (std::size_t i = 0; i < plot_.points.size(); ++i)
        if (plot_.points[i].is_muted == is_muted) add_point(i);
  }

  void add_point(std::size_t i) {
    const PlotPoint& point = plot_.points[i];
    const PlotPlace& at = layout_.points[i];
    add(R"svg(<g class="point c{}{}{}" data-key="{}" transform="translate({:.1f} {:.1f})">)svg",
        point.series % kPlotColours, point.is_muted ? " muted" : "",
        point.is_hollow ? " hollow" : "", html_text(point.key), at.x, at.y);
    if (point.stem)
      add(R"(<path class="stem" d="M0 0V{:.1f}"/>)",
          layout_.y_of(plot_.y.place(*point.stem)) - at.y);
    add(R"(<path class="shape" d="{}"/></g>)"
        "\n",
        path_of(plot_.series[point.series].shape));
  }

  void add_labels() {
    for (const PlotLabel& label : layout_.labels)
      add(R"(<text class="label{}" x="{:.1f}" y="{:.1f}" text-anchor="{}">{}</text>)"
          "\n",
          label.is_for_wide_pages ? " extra" : "", label.x, label.y, label.anchor,
          html_text(plot_.points[label.point].label));
  }

  const SvgPlot& plot_;
  const PlotLayout layout_;
  std::string text_;
};

std::string legend(const SvgPlot& plot) {
  std::string items;
  for (std::size_t i = 0; i < plot.series.size(); ++i)
    items += legend_item(fmt::format("c{}", i % kPlotColours), plot.series[i].shape,
                         plot.series[i].name);
  if (!plot.muted_note.empty()) items += legend_item("muted", PlotShape::kCircle, plot.muted_note);
  if (!plot.hollow_note.empty())
    items += legend_item("hollow note", PlotShape::kCircle, plot.hollow_note);
  return items;
}

}  // namespace

std::string plot_html(const SvgPlot& plot) {
  return figure_html(plot.title, legend(plot), Drawing(plot).html());
}

}  // namespace planetree::tools
