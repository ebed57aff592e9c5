#include "tools/compare/compare_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/cli/size_text.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;
using Extreme = DeviationTally::Extreme;

Json json_of(const Vec3& point) { return {point.x, point.y, point.z}; }

// JSON has no infinity.
Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json json_of(const Extreme& extreme) {
  return {{"deviation", extreme.deviation},
          {"point", json_of(extreme.point)},
          {"nearest", json_of(extreme.nearest)}};
}

Json json_of(const HausdorffInterval& interval) {
  return {{"direction", "to_model"},
          {"lower", json_of(interval.lower)},
          {"upper", json_of(interval.upper)},
          {"point", interval.is_empty ? Json() : json_of(interval.at)},
          {"nearest", interval.has_nearest ? json_of(interval.nearest) : Json()}};
}

Json percentiles(const ValueSketch& sketch, double (ValueSketch::*quantile)(double) const) {
  Json made = Json::object();
  for (const int percent : DeviationTally::kPercents)
    made[fmt::format("p{}", percent)] = (sketch.*quantile)(percent / 100.0);
  return made;
}

Json json_of(const ValueSketch::Histogram& histogram) {
  return {{"lower", histogram.lower},
          {"upper", histogram.upper},
          {"share_below", histogram.below},
          {"share_above", histogram.above},
          {"shares", histogram.shares}};
}

Json json_of(const ComparedMesh& mesh) {
  return {
      {"triangles", mesh.triangles}, {"skipped", mesh.skipped}, {"spacing", json_of(mesh.spacing)}};
}

Json hausdorff_json(const CompareRecord& record) {
  Json made = json_of(record.hausdorff);
  if (!record.mesh) return made;
  made["allowed_error"] = record.mesh->allowed_error;
  made["is_within_error"] = record.mesh->is_within_error;
  made["splits"] = record.mesh->splits;
  return made;
}

void add_counts(const DeviationTally& deviations, Json& report) {
  report["points"] = deviations.points();
  report["measured"] = deviations.measured();
  report["bad_query"] = deviations.count_of(Status::kBadQuery);
  report["beyond_max_distance"] = deviations.count_of(Status::kBeyondMaxDistance);
  report["degraded"] = deviations.count_of(Status::kDegraded);
  if (!deviations.is_signed()) return;
  report["inside"] = deviations.count_of(Side::kInside);
  report["outside"] = deviations.count_of(Side::kOutside);
  report["on_surface"] = deviations.count_of(Side::kOnSurface);
  report["side_unknown"] = deviations.count_of(Side::kUnknown);
}

void add_statistics(const DeviationTally& deviations, Json& report) {
  const ValueSketch& sketch = deviations.sketch();
  report["min"] = json_of(deviations.min());
  report["max"] = json_of(deviations.max());
  report["mean"] = deviations.mean();
  report["mean_absolute"] = deviations.mean_magnitude();
  report["rms"] = deviations.rms();
  report["percentiles"] = percentiles(sketch, &ValueSketch::quantile);
  report["absolute_percentiles"] = percentiles(sketch, &ValueSketch::quantile_of_magnitude);
  report["percentile_relative_error"] = ValueSketch::kRelativeError;
  report["histogram"] = json_of(histogram_of(deviations));
}

std::string place_text(const Vec3& point) {
  return fmt::format("{:.6g},{:.6g},{:.6g}", point.x, point.y, point.z);
}

std::string extreme_text(const char* name, const Extreme& extreme) {
  return fmt::format("  {:<9}{:>13.6g}  at {}\n", name, extreme.deviation,
                     place_text(extreme.point));
}

std::string percentiles_text(const char* name, const ValueSketch& sketch,
                             double (ValueSketch::*quantile)(double) const) {
  std::string text = fmt::format("  {:<9}", name);
  for (const int percent : DeviationTally::kPercents)
    text += fmt::format("{:>13.4g}", (sketch.*quantile)(percent / 100.0));
  return text + '\n';
}

std::string statistics_text(const DeviationTally& deviations) {
  std::string text = fmt::format("\ndeviation in model units{}\n",
                                 deviations.is_signed() ? ", negative inside" : ", without signs");
  text += extreme_text("min", deviations.min()) + extreme_text("max", deviations.max());
  text += fmt::format("  {:<9}{:>13.6g}\n  {:<9}{:>13.6g}\n\n  {:<9}", "mean", deviations.mean(),
                      "RMS", deviations.rms(), "");
  for (const int percent : DeviationTally::kPercents)
    text += fmt::format("{:>13}", fmt::format("p{}", percent));
  text += '\n';
  if (deviations.is_signed())
    text += percentiles_text("signed", deviations.sketch(), &ValueSketch::quantile);
  text += percentiles_text("absolute", deviations.sketch(), &ValueSketch::quantile_of_magnitude);
  if (deviations.tolerance())
    text += fmt::format("\nbeyond {:g}: {} point{}, {:.3g} %\n", *deviations.tolerance(),
                        grouped_count(deviations.beyond()), deviations.beyond() == 1 ? "" : "s",
                        100 * deviations.share_beyond());
  return text;
}

}  // namespace

std::string counts_text(const CompareRecord& record) {
  const DeviationTally& deviations = record.deviations;
  std::string text =
      fmt::format("{} {}{}", grouped_count(deviations.points()), record.mesh ? "corner" : "point",
                  deviations.points() == 1 ? "" : "s");
  if (record.mesh)
    text = fmt::format("{} triangle{}, measured at {}", grouped_count(record.mesh->triangles),
                       record.mesh->triangles == 1 ? "" : "s", text);
  const char* before = ": ";
  const auto add = [&](std::uint64_t count, const char* what) {
    if (count == 0) return;
    text += fmt::format("{}{} {}", before, grouped_count(count), what);
    before = ", ";
  };
  if (deviations.is_signed()) {
    add(deviations.count_of(Side::kInside), "inside");
    add(deviations.count_of(Side::kOutside), "outside");
    add(deviations.count_of(Side::kOnSurface), "on the surface");
    add(deviations.count_of(Side::kUnknown), "of unknown side");
  }
  add(deviations.count_of(Status::kBeyondMaxDistance), "beyond the maximum distance");
  add(deviations.count_of(Status::kBadQuery), "not finite");
  return text;
}

std::string compare_json(const CompareRecord& record) {
  const DeviationTally& deviations = record.deviations;
  Json report = {{"model_triangles", record.model_triangles}, {"diagonal", record.diagonal}};
  report["signed"] = deviations.is_signed();
  report["mesh"] = record.mesh ? json_of(*record.mesh) : Json();
  add_counts(deviations, report);
  add_statistics(deviations, report);
  if (deviations.tolerance())
    report["tolerance"] = {{"tolerance", *deviations.tolerance()},
                           {"beyond", deviations.beyond()},
                           {"share_beyond", deviations.share_beyond()}};
  report["hausdorff"] = hausdorff_json(record);
  report["colour_range"] = record.reach;
  report["seconds"] = record.seconds;
  report["points_per_second"] = static_cast<double>(deviations.points()) / record.seconds;
  report["pages_read"] = record.pages_read;
  report["budget_bytes"] = record.memory_bytes;
  report["peak_resident_bytes"] = peak_resident_bytes();
  return json_line(report);
}

std::string compare_words(const CompareRecord& record) {
  const DeviationTally& deviations = record.deviations;
  std::string text = fmt::format("{} against {} ({} triangles)\n{}\n", record.other, record.file,
                                 grouped_count(record.model_triangles), counts_text(record));
  if (deviations.measured() > 0) text += statistics_text(deviations);
  const HausdorffInterval& interval = record.hausdorff;
  if (!interval.is_empty)
    text += fmt::format(
        "\ngreatest distance to the model (one-sided Hausdorff), certified\n"
        "  at least {}\n  at most  {}\n  at {}\n",
        interval.lower, interval.upper, place_text(interval.at));
  if (record.mesh && !record.mesh->is_within_error)
    text += fmt::format("  wider than the allowed {:.3g}\n", record.mesh->allowed_error);
  return text;
}

}  // namespace planetree::tools
