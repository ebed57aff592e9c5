#include "tools/generate.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/generate_file.h"
#include "tools/generate_ply.h"
#include "tools/progress.h"
#include "tools/size_text.h"

namespace planetree::tools {
namespace {

struct Outcome {
  std::uint64_t triangles;
  std::uint64_t vertices;
  std::uint64_t file_bytes;
  double seconds;
};

int exit_status(ErrorCode code) {
  switch (code) {
    case ErrorCode::kBadArgument:
    case ErrorCode::kAlreadyExists:
    case ErrorCode::kNotFound:
      return 2;
    case ErrorCode::kPermission:
    case ErrorCode::kNoSpace:
    case ErrorCode::kNoMemory:
    case ErrorCode::kReadFailed:
    case ErrorCode::kWriteFailed:
      return 3;
    default:
      return 1;
  }
}

Result<Outcome> generate(const GenerateOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  const auto shape = make_shape(options.shape, options.triangles, options.seed);
  if (!shape) return shape.error();
  const std::string comment =
      fmt::format("planetree {} of {} triangles, seed {}; lengths may be read as millimetres",
                  shape_name(options.shape), (*shape)->triangle_count(), options.seed);

  auto file = OutputFile::create(options.output, options.force);
  if (!file) return file.error();
  const auto room = file->reserve(ply_bytes(**shape, comment));
  if (!room) return room.error();
  Progress progress(options.quiet);
  const auto written = write_ply(**shape, comment, *file, progress);
  if (!written) return written.error();
  const auto committed = file->commit();
  if (!committed) return committed.error();

  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - started;
  return Outcome{(*shape)->triangle_count(), (*shape)->vertex_count(), file->bytes_written(),
                 took.count()};
}

std::uint64_t peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

std::string json_report(const GenerateOptions& options, const Outcome& outcome) {
  const nlohmann::ordered_json report = {{"file", options.output.string()},
                                         {"shape", shape_name(options.shape)},
                                         {"seed", options.seed},
                                         {"triangles", outcome.triangles},
                                         {"vertices", outcome.vertices},
                                         {"file_bytes", outcome.file_bytes},
                                         {"seconds", outcome.seconds},
                                         {"peak_resident_bytes", peak_resident_bytes()}};
  // A file name need not be UTF-8, which JSON must be.
  return report.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string plain_report(const GenerateOptions& options, const Outcome& outcome) {
  const double rate = static_cast<double>(outcome.triangles) / std::max(outcome.seconds, 1e-9);
  return fmt::format("{}: {}, {} triangles, {} vertices, {} in {:.1f} s ({} triangles/s)",
                     options.output.string(), shape_name(options.shape),
                     grouped_count(outcome.triangles), grouped_count(outcome.vertices),
                     short_bytes(outcome.file_bytes), outcome.seconds, short_count(rate));
}

/// What is wrong with the text of a count, or nothing: the form CLI11 asks for.
std::string count_complaint(std::string& text) {
  const auto count = parse_count(text);
  return count ? std::string() : std::string(count.error().text);
}

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const ShapeKind kind : kAllShapeKinds) names.emplace_back(shape_name(kind));
  return names;
}

}  // namespace

int run_generate(const GenerateOptions& options) {
  const bool to_standard_output = options.output == "-";
  if (to_standard_output && isatty(STDOUT_FILENO) != 0) {
    fmt::print(stderr,
               "planetree: standard output is a terminal, which cannot show a model; "
               "redirect it or name a file\n");
    return 2;
  }
  const auto outcome = generate(options);
  if (!outcome) {
    const Error& error = outcome.error();
    const std::string place =
        error.offset == Error::kNowhere ? "" : fmt::format("at byte {}: ", error.offset);
    fmt::print(stderr, "planetree: {}: {}{}\n", options.output.string(), place, error.text);
    return exit_status(error.code);
  }
  fmt::print(to_standard_output ? stderr : stdout, "{}\n",
             options.json ? json_report(options, *outcome) : plain_report(options, *outcome));
  return 0;
}

void add_generate(CLI::App& app, std::function<int()>& action) {
  CLI::App* verb = app.add_subcommand(
      "generate", "Write a test model of any size, in constant memory, as a binary PLY file");
  const auto options = std::make_shared<GenerateOptions>();
  verb->add_option("output", options->output,
                   "PLY file to write; - is standard output, and the report then goes to "
                   "standard error")
      ->required()
      ->type_name("OUT.ply");
  verb->add_option_function<std::string>(
          "--triangles",
          [options](const std::string& text) { options->triangles = *parse_count(text); },
          "About how many triangles; K, M, G mean thousands, millions, billions")
      ->required()
      ->type_name("N")
      ->check(CLI::Validator(count_complaint, "", "count"));
  verb->add_option_function<std::string>(
          "--shape", [options](const std::string& name) { options->shape = *shape_named(name); },
          "statue (a displaced sphere), sphere (radius 100), cylinder (radius 100, height 200), "
          "cone (the same), terrain (side 200) or soup (in a unit cube)")
      ->type_name("NAME")
      ->default_str("statue")
      ->check(CLI::IsMember(shape_names()).description(""));
  // Read as a count, because CLI11 takes -1 for 2^64 - 1.
  verb->add_option_function<std::string>(
          "--seed", [options](const std::string& text) { options->seed = *parse_count(text); },
          "Number that chooses the noise of statue and terrain and the places of the soup")
      ->type_name("S")
      ->default_str("1")
      ->check(CLI::Validator(count_complaint, "", "count"));
  verb->add_flag("--json", options->json, "Report as one JSON object");
  verb->add_flag("--quiet", options->quiet, "Show no progress");
  verb->add_flag("--force", options->force, "Replace the file if it exists");
  verb->callback([options, &action] { action = [options] { return run_generate(*options); }; });
}

}  // namespace planetree::tools
