#include "tools/html/column_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "tools/html/html_text.h"
#include "tools/html/plot_figure.h"

namespace planetree::tools {
namespace {

// In units of the drawing, with the text sizes of the page's style.
constexpr double kWidth = 480, kHeight = 280;
constexpr double kLeft = 70, kRight = 18, kTop = 34;
constexpr double kBandGap = 4, kBandHeight = 9;

/// Appends the parts of a plot's drawing.
class ColumnDrawing {
 public:
  explicit ColumnDrawing(const ColumnPlot& plot)
      : plot_(plot),
        bottom_(kHeight - (plot.band.empty() ? 46 : 46 + kBandGap + kBandHeight + 7)) {}

  std::string html() {
    text_ = svg_begin({plot_.id, plot_.title, plot_.description, kWidth, kHeight});
    add_y_axis();
    add_x_axis();
    for (const PlotColumn& column : plot_.columns) add_column(column);
    add_marks();
    if (!plot_.band.empty()) add_band();
    return text_ + "</svg>\n";
  }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Values>(values)...);
  }
  double x_of(double place) const { return kLeft + place * (kWidth - kLeft - kRight); }
  double y_of(double place) const { return bottom_ - place * (bottom_ - kTop); }

  void add_y_axis() {
    for (const PlotTick& tick : plot_.y.ticks()) {
      const double y = y_of(tick.place);
      add(R"(<path class="grid" d="M{:g} {:.1f}H{:g}"/>)", kLeft, y, kWidth - kRight);
      add(R"(<text class="tick" x="{:g}" y="{:.1f}" text-anchor="end">{}</text>)"
          "\n",
          kLeft - 6, y + 4, html_text(tick.text));
    }
    add(R"(<text class="title" x="4" y="14">{}</text>)"
        "\n",
        html_text(plot_.y.title()));
  }

  void add_x_axis() {
    const double y = bottom_ + (plot_.band.empty() ? 0 : kBandGap + kBandHeight) + 17;
    for (std::size_t i = 0; i < plot_.x.ticks().size(); ++i) {
      const PlotTick& tick = plot_.x.ticks()[i];
      add(R"(<text class="{}" x="{:.1f}" y="{:g}" text-anchor="middle">{}</text>)"
          "\n",
          tick_class(plot_.x, i), std::clamp(x_of(tick.place), kLeft + 6, kWidth - kRight - 12), y,
          html_text(tick.text));
    }
    add(R"(<text class="title" x="{:.1f}" y="{:g}" text-anchor="middle">{}</text>)"
        "\n",
        (kLeft + kWidth - kRight) / 2, kHeight - 8, html_text(plot_.x.title()));
  }

  /// The column, and the area from top to bottom where a pointer is on it.
  void add_column(const PlotColumn& column) {
    if (!(column.y > 0)) return;
    const double left = x_of(plot_.x.place(column.from)), right = x_of(plot_.x.place(column.to));
    const double gap = std::min(0.3, (right - left) / 4);
    const double lower = column.bottom ? y_of(plot_.y.place(*column.bottom)) : bottom_;
    const double upper = std::min(y_of(plot_.y.place(column.y)), lower - 0.5);
    add(R"(<g class="point c{}" data-key="{}">)"
        R"(<rect class="shape column" x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}"/>)",
        column.series % kPlotColours, html_text(column.key), left + gap, upper,
        right - left - 2 * gap, lower - upper);
    if (column.series > 0)
      add(R"svg(<path class="shape" transform="translate({:.1f} {:.1f})" d="{}"/>)svg",
          (left + right) / 2, upper, path_of(plot_.series[column.series].shape));
    add(R"(<rect class="hit" x="{:.2f}" y="{:g}" width="{:.2f}" height="{:g}"/></g>)"
        "\n",
        left, kTop, right - left, bottom_ - kTop);
  }

  void add_marks() {
    for (const ColumnMark& mark : plot_.marks) {
      const double place = plot_.x.place(mark.x);
      if (place < 0 || place > 1) continue;
      add(R"(<path class="mark dashed" d="M{:.1f} {:g}V{:g}"><title>{}</title></path>)"
          "\n",
          x_of(place), kTop, bottom_, html_text(mark.text));
    }
  }

  void add_band() {
    const auto cells = static_cast<double>(plot_.band.size());
    const double width = (kWidth - kLeft - kRight) / cells;
    for (std::size_t i = 0; i < plot_.band.size(); ++i)
      add(R"(<rect x="{:.2f}" y="{:g}" width="{:.2f}" height="{:g}" fill="{}"/>)"
          "\n",
          kLeft + width * static_cast<double>(i), bottom_ + kBandGap,
          i + 1 < plot_.band.size() ? width + 1 : width, kBandHeight, plot_.band[i]);
    add(R"(<rect class="frame" x="{:g}" y="{:g}" width="{:g}" height="{:g}"/>)"
        "\n",
        kLeft, bottom_ + kBandGap, kWidth - kLeft - kRight, kBandHeight);
  }

  const ColumnPlot& plot_;
  const double bottom_;  // of the columns
  std::string text_;
};

/// Series, what dashes mean, and the notes.
std::string legend(const ColumnPlot& plot) {
  std::string items;
  for (std::size_t i = 0; i < plot.series.size() && plot.series.size() > 1; ++i)
    items += legend_item(fmt::format("c{}", i % kPlotColours), plot.series[i].shape,
                         plot.series[i].name);
  for (const ColumnMark& mark : plot.marks)
    if (const double place = plot.x.place(mark.x); place >= 0 && place <= 1) {
      items += legend_item("dashes: " + mark.text);
      break;
    }
  for (const std::string& note : plot.notes) items += legend_item(note);
  return items;
}

}  // namespace

std::string column_plot_html(const ColumnPlot& plot) {
  return figure_html(plot.title, legend(plot), ColumnDrawing(plot).html());
}

}  // namespace planetree::tools
