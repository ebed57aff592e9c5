#include "tools/generate.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/cli/output_file.h"
#include "tools/cli/progress.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand_options.h"
#include "tools/shapes/generate_ply.h"
#include "tools/shapes/shape_holes.h"

namespace planetree::tools {
namespace {

struct Outcome {
  std::uint64_t triangles;
  std::uint64_t vertices;
  std::uint64_t file_bytes;
  double seconds;
};

Result<std::unique_ptr<Shape>> shape_of(const GenerateOptions& options) {
  auto shape = make_shape(options.shape, options.triangles, options.seed);
  if (!shape || options.holes == 0) return shape;
  if (options.holes > (*shape)->triangle_count() / 2)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "%llu holes are more than half of %llu triangles; leave out fewer",
                      static_cast<unsigned long long>(options.holes),
                      static_cast<unsigned long long>((*shape)->triangle_count()));
  return std::unique_ptr<Shape>(
      std::make_unique<HoledShape>(*std::move(shape), options.holes, options.seed));
}

std::string comment_of(const GenerateOptions& options, const Shape& shape) {
  const std::string holes =
      options.holes == 0 ? std::string() : fmt::format(", {} left out", options.holes);
  return fmt::format("planetree {} of {} triangles{}, seed {}; lengths may be read as millimetres",
                     shape_name(options.shape), shape.triangle_count(), holes, options.seed);
}

Result<Outcome> generate(const GenerateOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  const auto shape = shape_of(options);
  if (!shape) return shape.error();
  const std::string comment = comment_of(options, **shape);

  auto file = OutputFile::create(options.output, options.force);
  if (!file) return file.error();
  const auto space = file->reserve(ply_bytes(**shape, comment));
  if (!space) return space.error();
  Progress progress(options.quiet, options.json);
  const auto written = write_ply(**shape, comment, *file, progress);
  if (!written) return written.error();
  const auto committed = file->commit();
  if (!committed) return committed.error();

  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
  return Outcome{(*shape)->triangle_count(), (*shape)->vertex_count(), file->bytes_written(),
                 took.count()};
}

std::string json_report(const GenerateOptions& options, const Outcome& outcome) {
  const nlohmann::ordered_json report = {{"file", options.output.string()},
                                         {"shape", shape_name(options.shape)},
                                         {"seed", options.seed},
                                         {"holes", options.holes},
                                         {"triangles", outcome.triangles},
                                         {"vertices", outcome.vertices},
                                         {"file_bytes", outcome.file_bytes},
                                         {"seconds", outcome.seconds},
                                         {"peak_resident_bytes", peak_resident_bytes()}};
  return json_line(report);
}

std::string plain_report(const GenerateOptions& options, const Outcome& outcome) {
  const double rate = static_cast<double>(outcome.triangles) / std::max(outcome.seconds, 1e-9);
  return fmt::format("{}: {}, {} triangles, {} vertices, {} in {:.1f} s ({} triangles/s)\n",
                     options.output.string(), shape_name(options.shape),
                     grouped_count(outcome.triangles), grouped_count(outcome.vertices),
                     short_bytes(outcome.file_bytes), outcome.seconds, short_count(rate));
}

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const ShapeKind kind : kAllShapeKinds) names.emplace_back(shape_name(kind));
  return names;
}

}  // namespace

int run_generate(const GenerateOptions& options, Console& console) {
  const bool to_standard_output = options.output == "-";
  if (to_standard_output && console.output_is_terminal())
    return console.fail(
        "standard output",
        make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                   "a terminal cannot show a model; redirect standard output or name a file"));
  const auto outcome = generate(options);
  if (!outcome) return console.fail(options.output.string(), outcome.error());
  const std::string report =
      options.json ? json_report(options, *outcome) : plain_report(options, *outcome);
  if (to_standard_output)
    console.note(report);
  else
    console.print(report);
  return console.finish(kDone);
}

void add_generate(CLI::App& app, Console& console, std::function<int()>& action) {
  constexpr auto kAnyCount = std::numeric_limits<std::uint64_t>::max();
  const auto options = std::make_shared<GenerateOptions>();
  SubcommandOptions subcommand(
      app, "generate", "Write a test model of any size, in constant memory, as a binary PLY file");
  subcommand.require(
      subcommand.path("output", "OUT.ply", options->output,
                      "PLY file to write; - is standard output, and the report then goes to "
                      "standard error"));
  subcommand.require(subcommand.count(
      "--triangles", options->triangles, kAnyCount,
      "Approximate number of triangles; K, M and G mean thousands, millions and billions"));
  subcommand.default_text(
      subcommand.word(
          "--shape", shape_names(),
          [options](const std::string& name) { options->shape = *shape_named(name); },
          "statue (a displaced sphere), sphere (radius 100), cylinder (radius 100, height 200), "
          "cone (the same), terrain (side 200) or soup (in a unit cube)"),
      "statue");
  subcommand.default_text(
      subcommand.count(
          "--seed", options->seed, kAnyCount,
          "Seed for the noise of statue and terrain and for the positions of the soup"),
      "1");
  subcommand.default_text(
      subcommand.count(
          "--holes", options->holes, kAnyCount,
          "Number of triangles to leave out, spread over the model; at most half of them"),
      "0");
  subcommand.flag("--json", options->json,
                  "Report as one JSON object; progress as JSON lines, on standard error");
  subcommand.flag("--quiet", options->quiet, "Show no progress");
  subcommand.flag("--force", options->force, "Replace the file if it exists");
  subcommand.on_given([options, &console, &action] {
    action = [options, &console] { return run_generate(*options, console); };
    return std::string();
  });
}

}  // namespace planetree::tools
