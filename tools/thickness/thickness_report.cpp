#include "tools/thickness/thickness_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/cli/size_text.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kStatusTexts[] = {"exact", "within an interval", "degraded",
                                        "without a wall within the maximum thickness",
                                        "not finite"};

Json json_of(const Vec3& point) { return {point.x, point.y, point.z}; }

Json json_of(const WallThickness& wall) {
  if (!wall.has_contact) return {};
  return {{"thickness", wall.thickness},
          {"lower", wall.lower},
          {"upper", wall.upper},
          {"point", json_of(wall.at)},
          {"contact", json_of(wall.contact)}};
}

Json json_of(const ValueSketch::Histogram& histogram) {
  return {{"lower", histogram.lower},
          {"upper", histogram.upper},
          {"share_above", histogram.above},
          {"shares", histogram.shares}};
}

std::string place_text(const Vec3& point) {
  return fmt::format("{:.6g},{:.6g},{:.6g}", point.x, point.y, point.z);
}

}  // namespace

std::string counts_text(const ThicknessRecord& record) {
  std::string text =
      fmt::format("{} point{}", grouped_count(record.count), record.count == 1 ? "" : "s");
  const char* before = ": ";
  for (std::size_t i = 0; i < kThicknessStatuses; ++i) {
    if (record.by_status[i] == 0) continue;
    text += fmt::format("{}{} {}", before, grouped_count(record.by_status[i]), kStatusTexts[i]);
    before = ", ";
  }
  return text;
}

std::string thickness_json(const ThicknessRecord& record) {
  Json report = {{"model_triangles", record.model_triangles},
                 {"diagonal", record.diagonal},
                 {"points", record.count},
                 {"max_thickness", record.options.max_thickness}};
  for (std::size_t i = 0; i < kThicknessStatuses; ++i)
    report[name_of(static_cast<ThicknessStatus>(i))] = record.by_status[i];
  report["min"] = json_of(record.thinnest);
  report["max"] = record.sketch.max();
  report["mean"] = record.mean();
  for (const int percent : ThicknessRecord::kPercents)
    report["percentiles"][fmt::format("p{}", percent)] = record.sketch.quantile(percent / 100.0);
  report["percentile_relative_error"] = ValueSketch::kRelativeError;
  report["histogram"] = json_of(record.histogram());
  report["widest_interval"] = record.widest_interval;
  if (record.thin)
    report["thin"] = {{"thinner_than", *record.thin},
                      {"points", record.thinner},
                      {"share", record.share_thinner()}};
  report["seconds"] = record.seconds;
  report["points_per_second"] = static_cast<double>(record.count) / record.seconds;
  report["budget_bytes"] = record.memory_bytes;
  report["peak_resident_bytes"] = peak_resident_bytes();
  return json_line(report);
}

std::string thickness_words(const ThicknessRecord& record) {
  std::string text = fmt::format(
      "{} ({} triangles), at {}\n{}\n", record.file, grouped_count(record.model_triangles),
      record.points.empty() ? "the middles of parts of its triangles" : record.points,
      counts_text(record));
  if (!record.thinnest.has_contact) return text;
  text += fmt::format(
      "\nthickness in model units\n  {:<9}{:>13.6g}  at {}, to {}\n  {:<9}{:>13.6g}\n"
      "  {:<9}{:>13.6g}\n\n",
      "min", record.thinnest.thickness, place_text(record.thinnest.at),
      place_text(record.thinnest.contact), "max", record.sketch.max(), "mean", record.mean());
  std::string values;
  for (const int percent : ThicknessRecord::kPercents) {
    text += fmt::format("{:>13}", fmt::format("p{}", percent));
    values += fmt::format("{:>13.4g}", record.sketch.quantile(percent / 100.0));
  }
  text += '\n' + values + '\n';
  if (record.thin)
    text += fmt::format("\nthinner than {:g}: {} point{}, {:.3g} %\n", *record.thin,
                        grouped_count(record.thinner), record.thinner == 1 ? "" : "s",
                        100 * record.share_thinner());
  return text;
}

}  // namespace planetree::tools
