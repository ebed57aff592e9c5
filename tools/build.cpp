#include "tools/build.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "storage/system/file_error.h"
#include "tools/cli/coordinate_text.h"
#include "tools/cli/file_digest.h"
#include "tools/cli/file_text.h"
#include "tools/cli/progress.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand_options.h"

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxThreads = 1024;

const char* unit_of(octree::BuildPhase phase) {
  if (phase == octree::BuildPhase::kReading) return "bytes";
  return phase == octree::BuildPhase::kWriting ? "pages" : "parts";
}

/// The phase's key in JSON, such as "matching_edges".
std::string key_of(octree::BuildPhase phase) {
  std::string key = name_of(phase);
  std::replace(key.begin(), key.end(), ' ', '_');
  return key;
}

/// Shows the progress of the build. Records the time of each phase and the file of a failure.
class BuildMeter final : public octree::BuildProgress {
 public:
  BuildMeter(const BuildArguments& arguments, Console& console)
      : arguments_(arguments),
        console_(console),
        progress_(arguments.quiet, arguments.json),
        failed_at_(arguments.input) {}

  void progress(octree::BuildPhase phase, std::uint64_t done, std::uint64_t total) override {
    if (phase != phase_) {
      note_seconds();
      phase_ = phase;
      done_ = 0;
      progress_.start(name_of(phase), total, unit_of(phase));
    }
    if (done > done_) progress_.add(done - done_);
    done_ = std::max(done, done_);
  }
  void failed_at(octree::BuildDirectory, const fs::path& path) override { failed_at_ = path; }
  void resumes(const std::string& what) override {
    if (arguments_.quiet) return;
    console_.note(fmt::format("planetree: {}: {}\n", arguments_.output.string(), what));
  }
  void finish() {
    note_seconds();
    progress_.finish();
  }

  /// Seconds by phase, in the order of phases.
  const nlohmann::ordered_json& seconds() const { return seconds_; }
  const fs::path& failed_at() const { return failed_at_; }

 private:
  void note_seconds() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> elapsed = now - started_;
    if (phase_) seconds_[key_of(*phase_)] = elapsed.count();
    started_ = now;
  }

  const BuildArguments& arguments_;
  Console& console_;
  Progress progress_;
  fs::path failed_at_;
  std::optional<octree::BuildPhase> phase_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  nlohmann::ordered_json seconds_ = nlohmann::ordered_json::object();
  std::uint64_t done_ = 0;
};

/// Checks before the build what it would otherwise find only at its end.
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
  if (::access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) != 0)
    return storage::file_error(errno, storage::FileAction::kWrite, "write to its directory");
  return {};
}

double bytes_per_triangle(const storage::FileHeader& header) {
  return static_cast<double>(header.file_bytes) / static_cast<double>(header.model.triangle_count);
}

std::string json_report(const BuildArguments& arguments, const octree::BuildReport& built,
                        double seconds, const BuildMeter& meter, const std::string& sha256) {
  const storage::FileHeader& header = built.header;
  const storage::ModelRecord& model = header.model;
  nlohmann::ordered_json report = {
      {"input", arguments.input.string()},
      {"file", arguments.output.string()},
      {"triangles", model.triangle_count},
      {"input_triangles", built.input_triangles},
      {"skipped", model.skipped_count},
      {"first_skipped", nullptr},
      {"vertices", model.vertex_count},
      {"watertight", model.unbalanced_edge_count == 0},
      {"unbalanced_edges", model.unbalanced_edge_count},
      {"levels", model.height},
      {"nodes", model.node_count},
      {"blocks", model.block_count},
      {"pages", header.page_count},
      {"page_bytes", header.page_bytes},
      {"file_bytes", header.file_bytes},
      {"bytes_per_triangle", bytes_per_triangle(header)},
      {"seconds", seconds},
      {"seconds_by_phase", meter.seconds()},
      {"triangles_per_second", static_cast<double>(built.input_triangles) / seconds},
      {"peak_resident_bytes", peak_resident_bytes()},
      {"temporary_bytes", built.temporary_bytes},
      {"sha256", sha256},
      {"content_id", content_id_text(header.content_id)}};
  if (model.first_skipped != storage::kNoTriangle) report["first_skipped"] = model.first_skipped;
  return json_line(report);
}

std::string plain_report(const BuildArguments& arguments, const octree::BuildReport& built,
                         double seconds) {
  const storage::FileHeader& header = built.header;
  const storage::ModelRecord& model = header.model;
  const std::string part =
      model.has_region() ? " of " + grouped_count(built.input_triangles) : std::string();
  const std::string surface =
      model.unbalanced_edge_count == 0
          ? "watertight"
          : grouped_count(model.unbalanced_edge_count) + " unbalanced edges";
  return fmt::format(
      "{}: {}{} triangles, {}, {} in {} pages ({:.1f} bytes a triangle), in {:.1f} s ({} "
      "triangles/s), {} peak memory\n",
      arguments.output.string(), grouped_count(model.triangle_count), part, surface,
      short_bytes(header.file_bytes), grouped_count(header.page_count), bytes_per_triangle(header),
      seconds, short_count(static_cast<double>(built.input_triangles) / seconds),
      short_bytes(peak_resident_bytes()));
}

void warn_of_skipped(const BuildArguments& arguments, const octree::BuildReport& report,
                     Console& console) {
  const std::uint64_t count = report.header.model.skipped_count;
  if (count == 0) return;
  console.warn(arguments.input.string(),
               fmt::format("{} triangle{} of bad records skipped, the first: {}; repair the "
                           "mesh, or use --strict to refuse it",
                           grouped_count(count), count == 1 ? "" : "s", report.first_skipped));
}

std::string page_size_complaint(std::uint64_t bytes) {
  if (std::has_single_bit(bytes) && bytes >= storage::kMinPageBytes &&
      bytes <= storage::kMaxPageBytes)
    return {};
  return fmt::format("--page-size: {} is not a page size; give a power of two from 4K to 256K",
                     bytes);
}

std::string box_complaint(const std::string& text) {
  std::array<double, 6> values{};
  bool good = parse_coordinates(text, values);
  for (std::size_t axis = 0; axis < 3; ++axis) good = good && values[axis] <= values[axis + 3];
  if (good) return {};
  return fmt::format(
      "'{}' is not a box; give X0,Y0,Z0,X1,Y1,Z1, finite numbers with X0 <= X1, Y0 <= Y1 and Z0 <= "
      "Z1",
      octree::printable(text));
}

octree::RegionBox box_of(const std::string& text) {
  std::array<double, 6> v{};
  parse_coordinates(text, v);
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

std::string memory_complaint(std::uint64_t bytes) {
  constexpr std::uint64_t kMin = octree::BuildMemory::kMinBytes;
  if (bytes == 0 || bytes >= kMin) return {};
  return fmt::format("--memory: {} is too little for a build; give {}M or more", bytes, kMin >> 20);
}

}  // namespace

int run_build(const BuildArguments& arguments, Console& console) {
  if (const auto checked = check_output(arguments); !checked)
    return console.fail(arguments.output.string(), checked.error());
  const fs::path temporary = arguments.options.spill_directory(arguments.output);
  if (std::error_code ignored; !fs::is_directory(temporary, ignored))
    return console.fail(temporary.string(),
                        make_error(ErrorCode::kNotFound, Error::kNowhere, Error::kNowhere,
                                   "no such directory for temporary files; create it first"));
  const auto started = std::chrono::steady_clock::now();
  BuildMeter meter(arguments, console);
  const auto report =
      octree::build_tree(arguments.input, arguments.output, arguments.options, meter);
  meter.finish();
  if (!report) return console.fail(meter.failed_at().string(), report.error());
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  const double seconds = std::max(elapsed.count(), 1e-9);
  warn_of_skipped(arguments, *report, console);
  if (!arguments.json) {
    console.print(plain_report(arguments, *report, seconds));
    return console.finish(kDone);
  }
  const auto sha256 = sha256_of_file(arguments.output);
  if (!sha256) return console.fail(arguments.output.string(), sha256.error());
  console.print(json_report(arguments, *report, seconds, meter, *sha256));
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
  SubcommandOptions subcommand(app, "build", "Build the .ptree file of a mesh");
  subcommand.require(subcommand.path("input", "IN", arguments.input,
                                     "Mesh to read: PLY, STL or OFF (ascii or binary) or OBJ"));
  subcommand.require(subcommand.path("-o,--output", "OUT.ptree", arguments.output,
                                     "File to write; it appears only when it is complete"));
  subcommand.default_text(
      subcommand.count(
          "--threads", options->threads, kMaxThreads,
          "Number of threads; 0 means one for each processor. The file does not depend on it"),
      "0");
  subcommand.default_text(
      subcommand.bytes("--memory", arguments.options.memory_bytes,
                       "Maximum memory for the build; data that does not fit goes to temporary "
                       "files. The file does not depend on it"),
      "a quarter of the machine's memory");
  subcommand.path("--temp-dir", "DIR", arguments.options.temp_directory,
                  "Directory for temporary files; by default that of the output. They take about "
                  "120 bytes a triangle if memory is short, or 200 with double coordinates. They "
                  "have no names and vanish with the process, except for the checkpoint of "
                  "--resume. The build does not begin if space is too short");
  subcommand.text(
      "--box", "X0,Y0,Z0,X1,Y1,Z1", box_complaint,
      [&arguments](const std::string& text) { arguments.options.box = box_of(text); },
      "Build only the triangles that touch this box, in model units. Sides and watertightness are "
      "those of the whole mesh. Answers are exact where the surface is nearer than the box's "
      "walls; intervals hold everywhere. Sides are known within the box, if the mesh is "
      "watertight");
  subcommand.flag(
      "--resume", arguments.options.resume,
      "Keep a checkpoint in the directory OUT.ptree.work, next to the output or in --temp-dir, "
      "until the file is complete. Resume from the checkpoint of an interrupted build with "
      "--resume of the same input and options. The file does not depend on it");
  subcommand.default_text(
      subcommand.bytes("--page-size", options->page_bytes,
                       "Bytes of a page in memory: a power of two from 4K to 256K"),
      "64K");
  subcommand.flag("--strict", arguments.options.strict,
                  "Refuse a mesh with bad records (a vertex that is not finite, an index out of "
                  "range, fewer than 3 corners) instead of skipping them");
  subcommand.flag("--force", arguments.options.replace, "Replace the output if it exists");
  subcommand.flag("--json", arguments.json,
                  "Report as one JSON object; progress as JSON lines, on standard error");
  subcommand.flag("--quiet", arguments.quiet, "Show no progress");
  subcommand.on_given([options, &console, &action] {
    options->arguments.options.threads = static_cast<unsigned>(options->threads);
    options->arguments.options.page_bytes = static_cast<std::uint32_t>(options->page_bytes);
    action = [options, &console] { return run_build(options->arguments, console); };
    const std::string complaint = page_size_complaint(options->page_bytes);
    return complaint.empty() ? memory_complaint(options->arguments.options.memory_bytes)
                             : complaint;
  });
}

}  // namespace planetree::tools
