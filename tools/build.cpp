#include "tools/build.h"

#include <fmt/format.h>

#include <chrono>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "tools/file_digest.h"
#include "tools/file_text.h"
#include "tools/progress.h"
#include "tools/size_text.h"
#include "tools/verb_options.h"

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostThreads = 1024;

/// Shows how far the build is, and remembers the phase: it tells whether the
/// input or the output is to blame for an error.
class BuildMeter final : public octree::BuildProgress {
 public:
  explicit BuildMeter(bool quiet) : progress_(quiet) {}

  void progress(octree::BuildPhase phase, std::uint64_t done, std::uint64_t total) override {
    if (phase != phase_) {
      phase_ = phase;
      done_ = 0;
      start(total);
    }
    if (done > done_) progress_.add(done - done_);
    done_ = std::max(done, done_);
  }
  void finish() { progress_.finish(); }
  bool is_writing() const {
    return phase_ == octree::BuildPhase::kBounding || phase_ == octree::BuildPhase::kColouring ||
           phase_ == octree::BuildPhase::kWriting;
  }

 private:
  void start(std::uint64_t total) {
    switch (*phase_) {
      case octree::BuildPhase::kReading:
        return progress_.start("reading", total, "bytes");
      case octree::BuildPhase::kClosing:
        return progress_.start("matching edges", total, "steps");
      case octree::BuildPhase::kOrdering:
        return progress_.start("ordering", total, "steps");
      case octree::BuildPhase::kBounding:
        return progress_.start("bounding", total, "steps");
      case octree::BuildPhase::kColouring:
        return progress_.start("colouring", total, "steps");
      case octree::BuildPhase::kWriting:
        return progress_.start("writing", total, "pages");
    }
  }

  Progress progress_;
  std::optional<octree::BuildPhase> phase_;
  std::uint64_t done_ = 0;
};

/// What a build would only find out at its end.
Result<void> check_output(const BuildArguments& arguments) {
  std::error_code ignored;
  const auto refuse = [](ErrorCode code, const char* text) {
    return make_error(code, Error::kNowhere, Error::kNowhere, "%s", text);
  };
  const fs::path& output = arguments.output;
  if (fs::is_directory(output, ignored))
    return refuse(ErrorCode::kBadArgument, "this is a directory; name a file in it");
  if (fs::equivalent(arguments.input, output, ignored))
    return refuse(ErrorCode::kBadArgument, "this is the input itself; name another output");
  if (fs::exists(fs::symlink_status(output, ignored)) && !arguments.options.replace)
    return refuse(ErrorCode::kAlreadyExists,
                  "the file exists; use --force to replace it, or another name");
  const fs::path folder = output.parent_path();
  if (!folder.empty() && !fs::is_directory(folder, ignored))
    return refuse(ErrorCode::kNotFound, "its directory does not exist; create it first");
  return {};
}

double bytes_per_triangle(const storage::FileHeader& header) {
  return static_cast<double>(header.file_bytes) / static_cast<double>(header.model.triangle_count);
}

std::string json_report(const BuildArguments& arguments, const storage::FileHeader& header,
                        double seconds, const std::string& sha256) {
  const storage::ModelRecord& model = header.model;
  nlohmann::ordered_json report = {
      {"input", arguments.input.string()},
      {"file", arguments.output.string()},
      {"triangles", model.triangle_count},
      {"set_aside", model.set_aside_count},
      {"first_set_aside", nullptr},
      {"vertices", model.vertex_count},
      {"watertight", model.open_edge_count == 0},
      {"open_edges", model.open_edge_count},
      {"levels", model.height},
      {"nodes", model.node_count},
      {"blocks", model.block_count},
      {"pages", header.page_count},
      {"page_bytes", header.page_bytes},
      {"file_bytes", header.file_bytes},
      {"bytes_per_triangle", bytes_per_triangle(header)},
      {"seconds", seconds},
      {"triangles_per_second", static_cast<double>(model.triangle_count) / seconds},
      {"peak_resident_bytes", peak_resident_bytes()},
      {"sha256", sha256},
      {"content_id", content_id_text(header.content_id)}};
  if (model.first_set_aside != storage::kNoTriangle)
    report["first_set_aside"] = model.first_set_aside;
  return json_line(report);
}

std::string plain_report(const BuildArguments& arguments, const storage::FileHeader& header,
                         double seconds) {
  const storage::ModelRecord& model = header.model;
  const std::string surface = model.open_edge_count == 0
                                  ? "watertight"
                                  : grouped_count(model.open_edge_count) + " open edges";
  return fmt::format(
      "{}: {} triangles, {}, {} in {} pages ({:.1f} bytes a triangle), in {:.1f} s "
      "({} triangles/s), {} of memory\n",
      arguments.output.string(), grouped_count(model.triangle_count), surface,
      short_bytes(header.file_bytes), grouped_count(header.page_count), bytes_per_triangle(header),
      seconds, short_count(static_cast<double>(model.triangle_count) / seconds),
      short_bytes(peak_resident_bytes()));
}

void warn_of_set_aside(const BuildArguments& arguments, const octree::BuildReport& report,
                       Console& console) {
  const std::uint64_t count = report.header.model.set_aside_count;
  if (count == 0) return;
  console.warn(arguments.input.string(),
               fmt::format("{} triangle{} of bad records set aside, the first: {}; repair the "
                           "mesh, or use --strict to refuse it",
                           grouped_count(count), count == 1 ? "" : "s", report.first_set_aside));
}

std::string page_size_complaint(std::uint64_t bytes) {
  if (std::has_single_bit(bytes) && bytes >= storage::kMinPageBytes &&
      bytes <= storage::kMaxPageBytes)
    return {};
  return fmt::format("--page-size: {} is not a page size; give a power of two from 4K to 256K",
                     bytes);
}

}  // namespace

int run_build(const BuildArguments& arguments, Console& console) {
  if (const auto checked = check_output(arguments); !checked)
    return console.fail(arguments.output.string(), checked.error());
  const auto started = std::chrono::steady_clock::now();
  BuildMeter meter(arguments.quiet);
  const auto report =
      octree::build_tree(arguments.input, arguments.output, arguments.options, meter);
  meter.finish();
  if (!report) {
    const fs::path& blamed = meter.is_writing() ? arguments.output : arguments.input;
    return console.fail(blamed.string(), report.error());
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  const double seconds = std::max(elapsed.count(), 1e-9);
  warn_of_set_aside(arguments, *report, console);
  if (!arguments.json) {
    console.print(plain_report(arguments, report->header, seconds));
    return console.finish(kDone);
  }
  const auto sha256 = sha256_of_file(arguments.output);
  if (!sha256) return console.fail(arguments.output.string(), sha256.error());
  console.print(json_report(arguments, report->header, seconds, *sha256));
  return console.finish(kDone);
}

void add_build(CLI::App& app, Console& console, std::function<int()>& action) {
  struct Options {
    BuildArguments arguments;
    std::uint64_t threads = 0;
    std::uint64_t page_bytes = octree::BuildOptions{}.page_bytes;
  };
  const auto options = std::make_shared<Options>();
  BuildArguments& arguments = options->arguments;
  VerbOptions verb(app, "build", "Build the .ptree file of a mesh");
  verb.require(verb.path("input", "IN", arguments.input,
                         "Mesh to read: PLY (ascii or binary), STL (ascii or binary) or OBJ"));
  verb.require(verb.path("-o,--output", "OUT.ptree", arguments.output,
                         "File to write; it appears whole or not at all"));
  verb.default_text(verb.count("--threads", options->threads, kMostThreads,
                               "Threads to work with; 0 means one for each processor. The file "
                               "does not depend on it"),
                    "0");
  verb.default_text(verb.bytes("--page-size", options->page_bytes,
                               "Bytes of a page in memory: a power of two from 4K to 256K"),
                    "64K");
  verb.flag("--strict", arguments.options.strict,
            "Refuse a mesh with bad records (a vertex that is not finite, an index out of range, "
            "fewer than 3 corners) instead of setting them aside");
  verb.flag("--force", arguments.options.replace, "Replace the output if it exists");
  verb.flag("--json", arguments.json, "Report as one JSON object");
  verb.flag("--quiet", arguments.quiet, "Show no progress");
  verb.on_given([options, &console, &action] {
    options->arguments.options.threads = static_cast<unsigned>(options->threads);
    options->arguments.options.page_bytes = static_cast<std::uint32_t>(options->page_bytes);
    action = [options, &console] { return run_build(options->arguments, console); };
    return page_size_complaint(options->page_bytes);
  });
}

}  // namespace planetree::tools
