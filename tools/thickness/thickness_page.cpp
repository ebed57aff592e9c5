#include "tools/thickness/thickness_page.h"

#include <fmt/format.h>

#include <utility>

#include "tools/cli/size_text.h"
#include "tools/html/html_page.h"
#include "tools/html/html_table.h"
#include "tools/html/html_text.h"
#include "tools/thickness/thickness_report.h"
#include "tools/values/histogram_html.h"

namespace planetree::tools {
namespace {

std::string place_text(const Vec3& point) {
  return fmt::format("{:.6g}, {:.6g}, {:.6g}", point.x, point.y, point.z);
}

HtmlFigures facts(const ThicknessRecord& record) {
  HtmlFigures made{"thickness", {}};
  const auto add = [&made](const char* name, std::string value) {
    made.values.emplace_back(name, std::move(value));
  };
  add("triangles", grouped_count(record.model_triangles));
  add("points", grouped_count(record.count));
  if (record.thinnest.has_contact) {
    add("least thickness", number_text(record.thinnest.thickness));
    add("mean", number_text(record.mean()));
  }
  if (record.thin)
    add("thinner than the limit",
        fmt::format("{} ({:.3g} %)", grouped_count(record.thinner), 100 * record.share_thinner()));
  return made;
}

HistogramFigure histogram_figure(const ThicknessRecord& record) {
  const std::string of_what = record.points.empty() ? "area" : "points";
  HistogramFigure figure;
  figure.id = "thickness";
  figure.title = "Thickness";
  figure.description = "A bar for each range of thickness, as high as the share of the " + of_what +
                       " in it. Below the bars, the colours of the thicknesses.";
  figure.x_title = "thickness in model units";
  figure.y_title = "share of the " + of_what;
  figure.histogram = record.histogram();
  if (record.thin) figure.marks.push_back({*record.thin, "limit"});
  return figure;
}

std::string percentile_table(const ThicknessRecord& record) {
  HtmlTable table{fmt::format("Percentiles in model units, within {:.2g} % of their values.",
                              100 * ValueSketch::kRelativeError),
                  {{"", "min"}},
                  {}};
  HtmlRow row;
  row.cells = {number_text(record.sketch.min())};
  for (const int percent : ThicknessRecord::kPercents) {
    table.columns.push_back({"", fmt::format("p{}", percent)});
    row.cells.push_back(number_text(record.sketch.quantile(percent / 100.0)));
  }
  table.columns.push_back({"", "max"});
  row.cells.push_back(number_text(record.sketch.max()));
  table.rows.push_back(std::move(row));
  return table_html(table);
}

std::string thinnest_html(const WallThickness& wall) {
  return section_html(
      "Thinnest place",
      paragraph_html(fmt::format("{} model units, certified to be from {} to {}, at {}. The "
                                 "opposite side is at {}.",
                                 number_text(wall.thickness), wall.lower, wall.upper,
                                 place_text(wall.at), place_text(wall.contact))));
}

}  // namespace

ColourScale thickness_colours(const ThicknessRecord& record) {
  return ColourScale::sequential(0, record.sketch.quantile(0.95));
}

std::string thickness_page(const ThicknessRecord& record, const std::string& command) {
  HtmlPage page;
  page.kind = "planetree thickness: thickness of walls";
  page.title = record.file;
  page.body = facts_html(facts(record)) + paragraph_html(counts_text(record) + ".");
  if (record.thinnest.has_contact)
    page.body +=
        section_html("Distribution", histogram_html(histogram_figure(record),
                                                    thickness_colours(record), page.figures) +
                                         percentile_table(record)) +
        thinnest_html(record.thinnest);
  page.body += section_html("Command", command_html("To make this page again", command));
  return page_html(page);
}

}  // namespace planetree::tools
