#include "tools/compare.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/cli/open_model.h"
#include "tools/cli/progress.h"
#include "tools/cli/side_option.h"
#include "tools/cli/subcommand_options.h"
#include "tools/compare/compare_page.h"
#include "tools/compare/compare_report.h"
#include "tools/compare/mesh_comparison.h"
#include "tools/model_beside.h"
#include "tools/points/columns_option.h"
#include "tools/points/row_reader.h"
#include "tools/values/coloured_cloud.h"
#include "tools/values/model_lengths.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kChunkPoints = 32768;
// What the command takes beside the model: program, threads, chunks of points and answers; for a
// mesh, its reader and the search for the greatest distance.
constexpr std::uint64_t kOwnBytes = std::uint64_t{40} << 20;
constexpr std::uint64_t kMeshBytes = std::uint64_t{48} << 20, kReaderBytes = kMeshBytes / 3;

class Compare {
 public:
  Compare(const CompareArguments& arguments, Console& console)
      : arguments_(arguments),
        console_(console),
        progress_(arguments.quiet, arguments.json),
        page_(arguments.page, console) {}

  int run() {
    if (const int status = open_outputs(); status != kDone) return status;
    const auto kind = arguments_.kind ? Result(*arguments_.kind) : input_kind(arguments_.other);
    if (!kind) return stop(arguments_.other.string(), kind.error());
    kind_ = *kind;
    const std::uint64_t own = kOwnBytes + (kind_ == InputKind::kMesh ? kMeshBytes : 0);
    const auto model =
        open_model_beside(own, arguments_.memory_bytes, arguments_.file, open_options(), console_);
    if (!model) return console_.fail(arguments_.file.string(), model.error());
    auto probe = Probe::create(*model);
    if (!probe) return console_.fail(arguments_.file.string(), probe.error());
    const double diagonal = box_diagonal(model->info());
    CompareRecord record{
        .file = arguments_.file.string(),
        .other = points_name(arguments_.other.string()),
        .model_triangles = model->info().triangles,
        .diagonal = diagonal,
        .deviations = DeviationTally(diagonal, !arguments_.is_unsigned, arguments_.tolerance),
        .mesh = {},
        .hausdorff = {},
        .memory_bytes = arguments_.memory_bytes};
    const int measured =
        kind_ == InputKind::kMesh ? measure_mesh(*probe, record) : measure_points(*probe, record);
    if (measured != kDone) return console_.finish(measured);
    record.reach = arguments_.reach.value_or(default_reach(record.deviations));
    record.seconds = std::max(seconds(), 1e-9);
    record.pages_read = model->stats().pages_read;
    if (const int status = report(record); status != kDone) return console_.finish(status);
    const auto lost = pages_lost(*model);
    return console_.finish(lost ? console_.fail(arguments_.file.string(), *lost) : kDone);
  }

 private:
  OpenOptions open_options() const {
    OpenOptions options;
    if (arguments_.is_unsigned) options.layers = kDistanceLayer | kFieldLayer;
    options.batch_threads = static_cast<unsigned>(arguments_.threads);
    return options;
  }

  /// The outputs must not be an input, and are opened first, so that nothing is measured in vain.
  int open_outputs() {
    const std::filesystem::path inputs[] = {arguments_.file, arguments_.other};
    if (const int status = page_.open(inputs); status != kDone) return status;
    if (arguments_.output.empty()) return kDone;
    if (const auto checked = check_is_no_input(arguments_.output, inputs); !checked)
      return console_.fail(arguments_.output.string(), checked.error());
    auto cloud =
        ColouredCloud::create(arguments_.output, "distance",
                              "deviation in model units, negative inside", arguments_.page.force);
    if (!cloud) return console_.fail(arguments_.output.string(), cloud.error());
    cloud_ = *std::move(cloud);
    return kDone;
  }

  QueryOptions query_options() const {
    QueryOptions options;
    options.parts = arguments_.is_unsigned ? kDistance : kDistance | kSide;
    options.side_rule = arguments_.side_rule;
    options.max_distance = arguments_.max_distance;
    return options;
  }

  int measure_points(Probe& probe, CompareRecord& record) {
    DeviationTally& deviations = record.deviations;
    const std::string& name = record.other;
    const QueryOptions options = query_options();
    const auto points =
        open_points(arguments_.other.string(), console_.input(), arguments_.columns);
    if (!points) return console_.fail(name, points.error());
    progress_.start("comparing", 0, "points");
    std::vector<Vec3> queries(kChunkPoints);
    std::vector<ClosestPoint> answers(kChunkPoints);
    for (;;) {
      const auto count = (*points)->read(queries);
      if (!count) return stop(name, count.error());
      if (*count == 0) break;
      const auto asked = std::span<const Vec3>(queries).first(*count);
      const auto answered = std::span(answers).first(*count);
      probe.closest_points(asked, answered, options);
      for (std::size_t i = 0; i < *count; ++i) {
        const double deviation = deviations.add(asked[i], answered[i]);
        if (!cloud_) continue;
        if (const auto added = cloud_->add(asked[i], deviation); !added)
          return stop(arguments_.output.string(), added.error());
      }
      progress_.add(*count);
    }
    if (deviations.points() == 0)
      return stop(name, make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                                   "it has no point; give at least one, as a line x,y,z"));
    progress_.finish();
    record.hausdorff = deviations.hausdorff();
    return kDone;
  }

  HausdorffGoal goal(double diagonal) const {
    constexpr double kErrorShare = 1e-6;  // of the diagonal
    return {arguments_.hausdorff_error, kErrorShare * diagonal, arguments_.max_splits};
  }

  int measure_mesh(Probe& probe, CompareRecord& record) {
    constexpr double kSpacingShare = 1.0 / 200;  // of the diagonal
    const HausdorffGoal wanted = goal(record.diagonal);
    HausdorffSearch search(probe, wanted, arguments_.max_distance);
    MeshComparison comparison(probe, query_options(), record.diagonal, record.deviations, search,
                              cloud_.get());
    ComparedMesh mesh;
    mesh.spacing = arguments_.spacing.value_or(kSpacingShare * record.diagonal);
    const std::uint64_t triangles = estimated_triangles(arguments_.other);
    const auto cuts = arguments_.spacing ? MeshPieceMaker::Cuts{mesh.spacing}
                                         : MeshPieceMaker::modest_cuts(mesh.spacing, triangles);
    MeshPieceMaker maker(cuts, [&](const MeshPiece& piece) { return comparison.take(piece); });
    progress_.start("comparing", triangles, "triangles");
    const auto found = read_mesh_pieces(arguments_.other, kReaderBytes, maker,
                                        [this](std::uint64_t count) { progress_.add(count); });
    if (!found) return stop(record.other, found.error());
    progress_.start("bounding", search.waiting(), "triangles");
    const auto refined = search.refine([this](std::uint64_t count) { progress_.add(count); });
    if (!refined) return stop(record.other, refined.error());
    progress_.finish();
    warn_of(*found);
    mesh.triangles = found->triangles;
    mesh.skipped = found->skipped;
    mesh.splits = search.splits();
    mesh.is_within_error = search.is_within_error();
    mesh.allowed_error = wanted.error_for(search.interval().lower);
    record.mesh = mesh;
    record.hausdorff = search.interval();
    return kDone;
  }

  void warn_of(const MeshFindings& found) {
    for (const std::string& note : found.notes) console_.warn(arguments_.other.string(), note);
    if (found.skipped > 0)
      console_.warn(arguments_.other.string(),
                    std::to_string(found.skipped) +
                        " triangles of bad records skipped, the first: " + found.first_skipped);
  }

  int report(const CompareRecord& record) {
    if (cloud_)
      if (const auto written = cloud_->commit(ColourScale::diverging(record.reach)); !written)
        return console_.fail(arguments_.output.string(), written.error());
    return page_.report(arguments_.json ? compare_json(record) : compare_words(record),
                        [&] { return compare_page(record, compare_command(arguments_)); });
  }

  int stop(const std::string& file, const Error& error) {
    progress_.finish();
    return console_.fail(file, error);
  }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  }

  const CompareArguments& arguments_;
  Console& console_;
  Progress progress_;
  ReportPage page_;
  InputKind kind_ = InputKind::kPoints;
  std::unique_ptr<ColouredCloud> cloud_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

struct Options {
  CompareArguments arguments;
  // Infinite if not given.
  double tolerance = std::numeric_limits<double>::infinity();
  double reach = std::numeric_limits<double>::infinity();
  double spacing = std::numeric_limits<double>::quiet_NaN();  // if not given
  double hausdorff_error = std::numeric_limits<double>::infinity();
};

void add_files(SubcommandOptions& subcommand, CompareArguments& arguments) {
  subcommand.require(subcommand.path("file", "FILE", arguments.file,
                                     "Model to compare with, a file that planetree build wrote"));
  subcommand.require(subcommand.path(
      "other", "POINTS_OR_MESH", arguments.other,
      "What to compare, in model units. Points: text with one point a line (see --columns), PLY "
      "without faces, LAS, .npy, or .f64 (raw little-endian float64 triples); - is standard input, "
      "all "
      "but .f64. Mesh: any format that planetree build reads, also compressed"));
  static const std::map<std::string, InputKind> kinds = {{"points", InputKind::kPoints},
                                                         {"mesh", InputKind::kMesh}};
  subcommand.default_text(
      subcommand.word(
          "--read-as", {"points", "mesh"},
          [&arguments](const std::string& name) { arguments.kind = kinds.at(name); },
          "points: of a PLY with faces, the vertices alone; mesh: a mesh, or an error"),
      "as the content tells");
  add_columns(subcommand, arguments.columns);
  subcommand.path(
      "-o,--output", "OUT.ply", arguments.output,
      "Also write the points, or the mesh in parts, with their deviation as `distance` and its "
      "colour: blue inside, light grey at 0, red outside. A file named .vtp is a VTK file, one "
      "named "
      ".npy a NumPy array of the points, any other a binary PLY");
  add_page_path(subcommand, arguments.page);
  subcommand.flag("--force", arguments.page.force, "Replace the output and the page if they exist");
}

void add_measures(SubcommandOptions& subcommand, Options& options) {
  CompareArguments& arguments = options.arguments;
  subcommand.length("--tolerance", options.tolerance, false,
                    "Also count the points that deviate by more than this, in model units");
  subcommand.default_text(
      subcommand.length("--colour-range", options.reach, false,
                        "Deviation that has the darkest colours, in model units"),
      "the 95th percentile of the deviations without signs");
  subcommand.default_text(
      subcommand.length("--max-distance", arguments.max_distance, true,
                        "Search no farther than this, in model units. Points beyond it are "
                        "counted, and have no part in the statistics"),
      "inf");
  subcommand.default_text(
      subcommand.length("--spacing", options.spacing, true,
                        "Cut the triangles of a mesh until no edge is longer than this, in model "
                        "units. Deviations are measured at the corners of the parts"),
      "1/200 of the diagonal of the model's box, for at most about 4 million parts");
  subcommand.default_text(
      subcommand.length("--hausdorff-error", options.hausdorff_error, false,
                        "Width of the interval of a mesh's greatest distance, in model units"),
      "1 % of its lower end, or 1e-6 of the diagonal if that is more");
  subcommand.default_text(
      subcommand.count("--max-splits", arguments.max_splits,
                       std::numeric_limits<std::uint64_t>::max(),
                       "Split at most this many triangles for that. After them the interval holds, "
                       "and may be wider"),
      "50M");
  const auto is_unsigned =
      subcommand.flag("--unsigned", arguments.is_unsigned,
                      "Report distances without signs; sides are not computed, which takes less "
                      "time and memory");
  SubcommandOptions::exclude(add_side(subcommand, arguments.side_rule), is_unsigned);
}

}  // namespace

int run_compare(const CompareArguments& arguments, Console& console) {
  return Compare(arguments, console).run();
}

void add_compare(CLI::App& app, Console& console, std::function<int()>& action) {
  const auto options = std::make_shared<Options>();
  CompareArguments& arguments = options->arguments;
  SubcommandOptions subcommand(app, "compare",
                               "Measure how far points or a mesh deviate from a model, and map it");
  add_files(subcommand, arguments);
  add_measures(subcommand, *options);
  subcommand.default_text(
      subcommand.bytes("--memory", arguments.memory_bytes, "Maximum memory of the command"),
      "256M");
  subcommand.default_text(
      subcommand.count(
          "--threads", arguments.threads, OpenOptions::kMaxBatchThreads,
          "Number of threads; 0 means one for each processor. Results do not depend on it"),
      "0");
  subcommand.flag("--json", arguments.json,
                  "Report as one JSON object; progress as JSON lines on standard error");
  subcommand.flag("--quiet", arguments.quiet, "Show no progress");
  subcommand.on_given([options, &console, &action]() -> std::string {
    CompareArguments& given = options->arguments;
    if (given.kind == InputKind::kMesh && given.other == "-")
      return "a mesh is read at several places, which standard input does not allow; name a file";
    if (given.output == "-") return "--output needs a file; standard output is for the report";
    if (std::isfinite(options->tolerance)) given.tolerance = options->tolerance;
    if (std::isfinite(options->reach)) given.reach = options->reach;
    if (!std::isnan(options->spacing)) given.spacing = options->spacing;
    if (std::isfinite(options->hausdorff_error)) given.hausdorff_error = options->hausdorff_error;
    if (given.spacing && !(*given.spacing > 0)) return "--spacing 0 cuts without end; give more";
    if (given.tolerance && *given.tolerance > given.max_distance)
      return "--tolerance is above --max-distance, beyond which nothing is measured; raise that";
    action = [options, &console] { return run_compare(options->arguments, console); };
    return {};
  });
}

}  // namespace planetree::tools
