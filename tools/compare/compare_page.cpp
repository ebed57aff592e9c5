#include "tools/compare/compare_page.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "tools/cli/size_text.h"
#include "tools/compare/compare_report.h"
#include "tools/html/html_page.h"
#include "tools/html/html_table.h"
#include "tools/html/html_text.h"
#include "tools/values/histogram_html.h"

namespace planetree::tools {
namespace {

std::string place_text(const Vec3& point) {
  return fmt::format("{:.6g}, {:.6g}, {:.6g}", point.x, point.y, point.z);
}

HtmlFigures facts(const CompareRecord& record) {
  const DeviationTally& deviations = record.deviations;
  HtmlFigures made{"comparison", {}};
  const auto add = [&made](const char* name, std::string value) {
    made.values.emplace_back(name, std::move(value));
  };
  add("model", record.file);
  add("triangles of the model", grouped_count(record.model_triangles));
  if (record.mesh) add("triangles of the mesh", grouped_count(record.mesh->triangles));
  add(record.mesh ? "corners measured" : "points", grouped_count(deviations.points()));
  add("mean", number_text(deviations.mean()));
  add("RMS", number_text(deviations.rms()));
  if (deviations.tolerance())
    add("beyond the tolerance", fmt::format("{} ({:.3g} %)", grouped_count(deviations.beyond()),
                                            100 * deviations.share_beyond()));
  return made;
}

HistogramFigure histogram_figure(const CompareRecord& record) {
  const DeviationTally& deviations = record.deviations;
  const std::string of_what = record.mesh ? "area" : "points";
  HistogramFigure figure;
  figure.id = "deviations";
  figure.title = "Deviations";
  figure.description = "A bar for each range of deviations, as high as the share of the " +
                       of_what + " in it. Below the bars, the colours of the deviations.";
  figure.x_title = deviations.is_signed() ? "deviation in model units, negative inside"
                                          : "distance in model units";
  figure.y_title = "share of the " + of_what;
  figure.histogram = histogram_of(deviations);
  if (deviations.tolerance())
    for (const double sign : {1.0, -1.0})
      figure.marks.push_back({sign * *deviations.tolerance(), "tolerance"});
  return figure;
}

std::string percentile_table(const DeviationTally& deviations) {
  HtmlTable table{fmt::format("Percentiles in model units, within {:.2g} % of their values.",
                              100 * ValueSketch::kRelativeError),
                  {{"", "", HtmlColumn::Kind::kText}},
                  {}};
  table.columns.push_back({"", "min"});
  for (const int percent : DeviationTally::kPercents)
    table.columns.push_back({"", fmt::format("p{}", percent)});
  table.columns.push_back({"", "max"});
  const ValueSketch& sketch = deviations.sketch();
  if (deviations.is_signed()) {
    HtmlRow row;
    row.cells = {"with signs", number_text(sketch.min())};
    for (const int percent : DeviationTally::kPercents)
      row.cells.push_back(number_text(sketch.quantile(percent / 100.0)));
    row.cells.push_back(number_text(sketch.max()));
    table.rows.push_back(std::move(row));
  }
  HtmlRow row;
  row.cells = {"without signs", ""};
  for (const int percent : DeviationTally::kPercents)
    row.cells.push_back(number_text(sketch.quantile_of_magnitude(percent / 100.0)));
  row.cells.push_back(number_text(std::fmax(std::fabs(sketch.min()), std::fabs(sketch.max()))));
  table.rows.push_back(std::move(row));
  return table_html(table);
}

std::string place_table(const DeviationTally& deviations) {
  HtmlTable table{"Where the deviation is least and greatest.",
                  {{"", "", HtmlColumn::Kind::kText},
                   {"", "deviation"},
                   {"", "point", HtmlColumn::Kind::kText},
                   {"", "nearest point of the model", HtmlColumn::Kind::kText}},
                  {}};
  for (const auto& [name, extreme] :
       {std::pair{"least", deviations.min()}, std::pair{"greatest", deviations.max()}}) {
    HtmlRow row;
    row.cells = {name, number_text(extreme.deviation), place_text(extreme.point),
                 place_text(extreme.nearest)};
    table.rows.push_back(std::move(row));
  }
  return table_html(table);
}

std::string hausdorff_html(const CompareRecord& record) {
  const HausdorffInterval& interval = record.hausdorff;
  if (interval.is_empty) return {};
  const std::string upper =
      std::isfinite(interval.upper) ? fmt::format("{}", interval.upper) : "an unknown number of";
  std::string html = paragraph_html(fmt::format(
      "At least {} and at most {} model units, certified: no point{} is farther from the model. "
      "This is the one-sided Hausdorff distance. The farthest point found is at {}.",
      interval.lower, upper, record.mesh ? " of the mesh" : "", place_text(interval.at)));
  if (record.mesh && !record.mesh->is_within_error)
    html += paragraph_html(
        fmt::format("The interval is wider than the allowed {:.3g}.", record.mesh->allowed_error));
  return section_html("Greatest distance to the model", html);
}

}  // namespace

std::string compare_page(const CompareRecord& record, const std::string& command) {
  const DeviationTally& deviations = record.deviations;
  HtmlPage page;
  page.kind = "planetree compare: deviation from a model";
  page.title = record.other;
  page.body = facts_html(facts(record)) + paragraph_html(counts_text(record) + ".");
  if (deviations.measured() > 0)
    page.body += section_html("Distribution",
                              histogram_html(histogram_figure(record),
                                             ColourScale::diverging(record.reach), page.figures) +
                                  percentile_table(deviations) + place_table(deviations));
  page.body += hausdorff_html(record);
  page.body += section_html("Command", command_html("To make this page again", command));
  return page_html(page);
}

}  // namespace planetree::tools
