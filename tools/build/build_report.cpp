#include "tools/build/build_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tools/cli/attribute_option.h"
#include "tools/cli/file_digest.h"
#include "tools/cli/file_text.h"
#include "tools/cli/layer_words.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {
namespace {

/// A build that has ended.
struct BuildRecord {
  const std::vector<std::filesystem::path>& inputs;
  const std::filesystem::path& output;
  const BuildReport& built;
  double seconds = 0;                              ///< of the whole build, above 0
  const nlohmann::ordered_json& seconds_by_phase;  ///< in the order of phases
};

double bytes_per_triangle(const BuildReport& built) {
  return static_cast<double>(built.file_bytes) / static_cast<double>(built.triangles);
}

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::string> names;
  for (const std::filesystem::path& path : paths) names.push_back(path.string());
  return names;
}

std::string json_report(const BuildRecord& record, const std::string& sha256) {
  const BuildReport& built = record.built;
  nlohmann::ordered_json report = {
      {"input", nullptr},
      {"file", record.output.string()},
      {"triangles", built.triangles},
      {"input_triangles", built.input_triangles},
      {"skipped", built.skipped},
      {"first_skipped", nullptr},
      {"nonplanar_polygons", built.nonplanar_polygons},
      {"fanned_polygons", built.fanned_polygons},
      {"notes", built.notes},
      {"vertices", built.vertices},
      {"watertight", built.watertight()},
      {"unbalanced_edges", built.unbalanced_edges},
      {"side_rule", built.side_rule == SideRule::kSurface ? "surface" : "solid"},
      {"openness", built.openness},
      {"metadata", built.metadata},
      {"layers", layer_words(built.layers)},
      {"attributes", attribute_words(built.attributes)},
      {"levels", built.levels},
      {"nodes", built.nodes},
      {"blocks", built.blocks},
      {"pages", built.pages},
      {"page_bytes", built.page_bytes},
      {"file_bytes", built.file_bytes},
      {"bytes_per_triangle", bytes_per_triangle(built)},
      {"seconds", record.seconds},
      {"seconds_by_phase", record.seconds_by_phase},
      {"triangles_per_second", static_cast<double>(built.input_triangles) / record.seconds},
      {"peak_resident_bytes", built.peak_resident_bytes},
      {"temporary_bytes", built.temporary_bytes},
      {"sha256", sha256},
      {"content_id", content_id_text(built.content_id)}};
  if (record.inputs.size() == 1)
    report["input"] = record.inputs.front().string();
  else
    report["input"] = names_of(record.inputs);
  if (built.first_skipped != kNoTriangle) report["first_skipped"] = built.first_skipped;
  return json_line(report);
}

std::string plain_report(const BuildRecord& record) {
  const BuildReport& built = record.built;
  const std::string part = built.triangles < built.input_triangles
                               ? " of " + grouped_count(built.input_triangles)
                               : std::string();
  const std::string surface = built.watertight()
                                  ? "watertight"
                                  : grouped_count(built.unbalanced_edges) + " unbalanced edges";
  const std::string sheet = built.side_rule == SideRule::kSurface ? ", a sheet" : "";
  const std::string strays =
      built.strays > 0 ? grouped_count(built.strays) + " of them far outside, " : std::string();
  return fmt::format(
      "{}: {}{} triangles, {}{}, {} in {} pages ({:.1f} bytes a triangle), in {:.1f} s ({} "
      "triangles/s), {} peak memory\n",
      record.output.string(), grouped_count(built.triangles), part, strays, surface + sheet,
      short_bytes(built.file_bytes), grouped_count(built.pages), bytes_per_triangle(built),
      record.seconds, short_count(static_cast<double>(built.input_triangles) / record.seconds),
      short_bytes(built.peak_resident_bytes));
}

}  // namespace

int report_build(const Result<BuildReport>& built, BuildMeter& meter, const BuildFiles& files,
                 bool json, Console& console) {
  meter.finish();
  if (!built) return console.fail(name_of_failure(meter, files.inputs), built.error());
  const double seconds = meter.seconds();
  warn_of_mesh(mesh_name(files.inputs), *built, console);
  const BuildRecord record{files.inputs, files.output, *built, seconds, meter.seconds_by_phase()};
  if (!json) {
    console.print(plain_report(record));
    return console.finish(kDone);
  }
  const auto sha256 = sha256_of_file(files.output);
  if (!sha256) return console.fail(files.output.string(), sha256.error());
  console.print(json_report(record, *sha256));
  return console.finish(kDone);
}

}  // namespace planetree::tools
