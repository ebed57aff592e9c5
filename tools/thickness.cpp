#include "tools/thickness.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/cli/coordinate_text.h"
#include "tools/cli/open_model.h"
#include "tools/cli/progress.h"
#include "tools/cli/side_option.h"
#include "tools/cli/subcommand_options.h"
#include "tools/mesh/model_pieces.h"
#include "tools/model_beside.h"
#include "tools/points/columns_option.h"
#include "tools/points/row_reader.h"
#include "tools/thickness/thickness_page.h"
#include "tools/thickness/thickness_report.h"
#include "tools/thickness/thickness_rows.h"
#include "tools/values/coloured_cloud.h"
#include "tools/values/model_lengths.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kChunkPoints = 4096;
// What the command takes beside the model: program, threads, points and answers.
constexpr std::uint64_t kOwnBytes = std::uint64_t{40} << 20;
constexpr double kSpacingShare = 1.0 / 200;  // of the diagonal
constexpr double kMinAngle = 5, kMaxAngle = 80;

/// The sine of an angle from 0 to 90 degrees, by arithmetic alone, which is the same everywhere.
double sine_of_degrees(double degrees) {
  constexpr double kRadians = 0.017453292519943295;
  const double angle = degrees * kRadians;
  double term = angle, sum = 0;
  for (int i = 1; i < 30; i += 2) {
    sum += term;
    term *= -angle * angle / ((i + 1) * (i + 2));
  }
  return sum;
}

class Thickness {
 public:
  Thickness(const ThicknessArguments& arguments, Console& console)
      : arguments_(arguments),
        console_(console),
        progress_(arguments.quiet, arguments.json),
        page_(arguments.page, console) {}

  int run() {
    if (const int status = open_outputs(); status != kDone) return status;
    OpenOptions options;
    options.batch_threads = static_cast<unsigned>(arguments_.threads);
    const auto model =
        open_model_beside(kOwnBytes, arguments_.memory_bytes, arguments_.file, options, console_);
    if (!model) return console_.fail(arguments_.file.string(), model.error());
    auto probe = Probe::create(*model);
    if (!probe) return console_.fail(arguments_.file.string(), probe.error());
    ThicknessRecord record = begin(model->info());
    ThicknessSearch search(*probe, record.options);
    const int measured =
        arguments_.points.empty() ? measure_model(search, record) : measure_points(search, record);
    progress_.finish();
    if (measured != kDone) return console_.finish(measured);
    record.seconds = std::max(seconds(), 1e-9);
    if (const int status = report(record); status != kDone) return console_.finish(status);
    const auto lost = pages_lost(*model);
    return console_.finish(lost ? console_.fail(arguments_.file.string(), *lost) : kDone);
  }

 private:
  ThicknessRecord begin(const ModelInfo& info) const {
    const double diagonal = box_diagonal(info);
    ThicknessRecord record{.file = arguments_.file.string(),
                           .points = arguments_.points.empty()
                                         ? std::string()
                                         : points_name(arguments_.points.string()),
                           .model_triangles = info.triangles,
                           .diagonal = diagonal,
                           .options = {},
                           .thin = arguments_.thin,
                           .sketch = ValueSketch(diagonal),
                           .thinnest = {}};
    record.options.sine = sine_of_degrees(arguments_.min_angle_degrees);
    record.options.max_thickness = std::min(arguments_.max_thickness.value_or(diagonal), diagonal);
    record.options.scale = greatest_coordinate(info);
    record.options.side_rule = arguments_.side_rule;
    record.memory_bytes = arguments_.memory_bytes;
    return record;
  }

  /// The outputs must not be an input, and are opened first, so that nothing is measured in vain.
  int open_outputs() {
    const std::filesystem::path inputs[] = {arguments_.file, arguments_.points};
    if (const int status = page_.open(inputs); status != kDone) return status;
    for (const auto& output : {arguments_.output, arguments_.rows})
      if (const auto checked = check_is_no_input(output, inputs); !checked)
        return console_.fail(output.string(), checked.error());
    if (!arguments_.output.empty()) {
      auto cloud = ColouredCloud::create(arguments_.output, "thickness", "thickness in model units",
                                         arguments_.page.force);
      if (!cloud) return console_.fail(arguments_.output.string(), cloud.error());
      cloud_ = *std::move(cloud);
    }
    if (!arguments_.rows.empty()) {
      auto rows = OutputFile::create(arguments_.rows, arguments_.page.force);
      if (!rows) return console_.fail(arguments_.rows.string(), rows.error());
      rows_.emplace(*std::move(rows));
      if (const int status = write_rows(kThicknessHeader); status != kDone) return status;
    }
    return kDone;
  }

  int write_rows(const std::string& text) {
    const auto written = rows_->write(std::as_bytes(std::span(text)));
    return written ? kDone : console_.fail(arguments_.rows.string(), written.error());
  }

  /// Measures a chunk and writes its rows.
  int measure(ThicknessSearch& search, std::span<const Vec3> points) {
    walls_.resize(points.size());
    search.measure(points, walls_);
    return rows_ ? write_rows(thickness_rows(points, walls_)) : kDone;
  }

  int measure_points(ThicknessSearch& search, ThicknessRecord& record) {
    const auto points =
        open_points(arguments_.points.string(), console_.input(), arguments_.columns);
    if (!points) return console_.fail(record.points, points.error());
    progress_.start("measuring", 0, "points");
    std::vector<Vec3> chunk(kChunkPoints);
    for (;;) {
      const auto count = (*points)->read(chunk);
      if (!count) return console_.fail(record.points, count.error());
      if (*count == 0) break;
      const auto read = std::span<const Vec3>(chunk).first(*count);
      if (const int status = measure(search, read); status != kDone) return status;
      for (std::size_t i = 0; i < *count; ++i) {
        record.add(walls_[i], 1);
        if (!cloud_) continue;
        if (const auto added = cloud_->add(read[i], walls_[i].thickness); !added)
          return console_.fail(arguments_.output.string(), added.error());
      }
      progress_.add(*count);
    }
    if (record.count > 0) return kDone;
    return console_.fail(record.points,
                         make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                                    "it has no point; give at least one, as a line x,y,z"));
  }

  int measure_model(ThicknessSearch& search, ThicknessRecord& record) {
    int status = kDone;
    const auto cuts =
        arguments_.spacing
            ? MeshPieceMaker::Cuts{*arguments_.spacing}
            : MeshPieceMaker::modest_cuts(kSpacingShare * record.diagonal, record.model_triangles);
    MeshPieceMaker maker(cuts, [&](const MeshPiece& piece) -> Result<void> {
      status = measure_piece(search, piece, record);
      if (status == kDone) return {};
      // measure_piece() has reported it.
      return make_error(ErrorCode::kCancelled, Error::kNowhere, Error::kNowhere, "stopped");
    });
    progress_.start("measuring", record.model_triangles, "triangles");
    const auto read = read_model_pieces(arguments_.file, maker,
                                        [this](std::uint64_t count) { progress_.add(count); });
    if (status != kDone) return status;
    return read ? kDone : console_.fail(record.file, read.error());
  }

  int measure_piece(ThicknessSearch& search, const MeshPiece& piece, ThicknessRecord& record) {
    std::vector<std::array<Vec3, 3>> parts;
    for (const auto& [a, b, c] : piece.triangles)
      if (parts_seen_++ % arguments_.every == 0)
        parts.push_back({piece.corners[a], piece.corners[b], piece.corners[c]});
    for (std::size_t first = 0; first < parts.size(); first += kChunkPoints) {
      const auto chunk =
          std::span(parts).subspan(first).first(std::min(kChunkPoints, parts.size() - first));
      std::vector<Vec3> middles;
      for (const auto& [p, q, r] : chunk)
        middles.push_back({p.x / 3 + q.x / 3 + r.x / 3, p.y / 3 + q.y / 3 + r.y / 3,
                           p.z / 3 + q.z / 3 + r.z / 3});
      if (const int status = measure(search, middles); status != kDone) return status;
      for (std::size_t i = 0; i < chunk.size(); ++i) {
        record.add(walls_[i], std::max(area_of(chunk[i], record.diagonal),
                                       std::numeric_limits<double>::min()));
        if (!cloud_) continue;
        if (const auto added = draw(chunk[i], walls_[i].thickness); !added)
          return console_.fail(arguments_.output.string(), added.error());
      }
    }
    return kDone;
  }

  /// Triangles have corners of their own, since each has one thickness.
  Result<void> draw(const std::array<Vec3, 3>& corners, double thickness) {
    const std::uint64_t first = cloud_->point_count();
    for (const Vec3& corner : corners)
      if (const auto added = cloud_->add(corner, thickness); !added) return added;
    return cloud_->add_triangle({first, first + 1, first + 2});
  }

  int report(const ThicknessRecord& record) {
    if (cloud_)
      if (const auto written = cloud_->commit(thickness_colours(record)); !written)
        return console_.fail(arguments_.output.string(), written.error());
    if (rows_)
      if (const auto written = rows_->commit(); !written)
        return console_.fail(arguments_.rows.string(), written.error());
    return page_.report(arguments_.json ? thickness_json(record) : thickness_words(record),
                        [&] { return thickness_page(record, thickness_command(arguments_)); });
  }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  }

  const ThicknessArguments& arguments_;
  Console& console_;
  Progress progress_;
  ReportPage page_;
  std::unique_ptr<ColouredCloud> cloud_;
  std::optional<OutputFile> rows_;
  std::vector<WallThickness> walls_;
  std::uint64_t parts_seen_ = 0;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

struct Options {
  ThicknessArguments arguments;
  // NaN if not given.
  double max_thickness = std::numeric_limits<double>::quiet_NaN();
  double thin = std::numeric_limits<double>::quiet_NaN();
  double spacing = std::numeric_limits<double>::quiet_NaN();
};

void add_files(SubcommandOptions& subcommand, ThicknessArguments& arguments) {
  subcommand.require(
      subcommand.path("file", "FILE", arguments.file, "File that planetree build wrote"));
  subcommand.default_text(
      subcommand.path(
          "points", "POINTS", arguments.points,
          "Where to measure: at the surface points nearest to these, in model units. Text with one "
          "point a line (see --columns), PLY (its vertices), LAS, .npy or .f64 (raw "
          "little-endian float64 triples); - is standard input, all but .f64"),
      "the middles of the model's triangles, see --spacing");
  add_columns(subcommand, arguments.columns);
  subcommand.path("-o,--output", "OUT.ply", arguments.output,
                  "Also write the points, or the triangles, with `thickness` and its colour, from "
                  "dark violet (thin) to light yellow. A file named .vtp is a VTK file, one named "
                  ".npy a NumPy array of the points, any other a binary PLY");
  subcommand.path("--csv", "OUT.csv", arguments.rows,
                  "Also write a row for each point: "
                  "x,y,z,thickness,lower,upper,qx,qy,qz,status, where qx,qy,qz is the opposite "
                  "surface point");
  add_page_path(subcommand, arguments.page);
  subcommand.flag("--force", arguments.page.force, "Replace the files if they exist");
}

void add_measures(SubcommandOptions& subcommand, Options& options) {
  ThicknessArguments& arguments = options.arguments;
  subcommand.default_text(subcommand.length("--max-thickness", options.max_thickness, false,
                                            "Look for walls up to this thickness, in model units"),
                          "the diagonal of the model's box");
  subcommand.length("--thinner-than", options.thin, false,
                    "Also count the points where walls are thinner than this, in model units");
  subcommand.default_text(
      subcommand.length("--spacing", options.spacing, true,
                        "Without POINTS: cut the model's triangles until no edge is longer than "
                        "this, in model units, and measure at the middle of each part"),
      "1/200 of the diagonal of the model's box, for at most about 4 million parts");
  subcommand.default_text(
      subcommand.count("--every", arguments.every, std::numeric_limits<std::uint32_t>::max(),
                       "Without POINTS: measure at one of so many parts, to save time"),
      "1");
  const auto complaint = [](const std::string& text) -> std::string {
    double value = 0;
    const bool good = parse_coordinates(text, std::span(&value, 1));
    if (good && value >= kMinAngle && value <= kMaxAngle) return {};
    return "'" + text + "' is not an angle from 5 to 80";
  };
  const auto take = [&arguments](const std::string& text) {
    parse_coordinates(text, std::span(&arguments.min_angle_degrees, 1));
  };
  subcommand.default_text(
      subcommand.text("--min-angle", "DEGREES", complaint, take,
                      "Surface counts as the opposite side of a wall if it rises by at least this "
                      "angle above the tangent plane at the point, in degrees, 5 to 80. So the "
                      "facets of a round surface do not hide its walls"),
      "30");
  add_side(subcommand, arguments.side_rule);
}

}  // namespace

int run_thickness(const ThicknessArguments& arguments, Console& console) {
  return Thickness(arguments, console).run();
}

void add_thickness(CLI::App& app, Console& console, std::function<int()>& action) {
  const auto options = std::make_shared<Options>();
  ThicknessArguments& arguments = options->arguments;
  SubcommandOptions subcommand(app, "thickness",
                               "Measure how thick walls are, by balls that fit into them");
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
    ThicknessArguments& given = options->arguments;
    if (given.output == "-" || given.rows == "-")
      return "--output and --csv need files; standard output is for the report";
    const auto take = [](double value, std::optional<double>& to) {
      if (!std::isnan(value)) to = value;
    };
    take(options->max_thickness, given.max_thickness);
    take(options->thin, given.thin);
    take(options->spacing, given.spacing);
    if (given.spacing && !(*given.spacing > 0)) return "--spacing 0 cuts without end; give more";
    if (given.every == 0) return "--every 0 leaves no part to measure; give 1 or more";
    if (given.max_thickness && !(*given.max_thickness > 0))
      return "--max-thickness 0 leaves no wall to measure; give more";
    action = [options, &console] { return run_thickness(options->arguments, console); };
    return {};
  });
}

}  // namespace planetree::tools
