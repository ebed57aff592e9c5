#include "tools/build.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/cli/attribute_option.h"
#include "tools/cli/coordinate_text.h"
#include "tools/cli/file_digest.h"
#include "tools/cli/file_text.h"
#include "tools/cli/layer_option.h"
#include "tools/cli/progress.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand_options.h"
#include "tools/report/build_report.h"

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxThreads = 1024;

const char* unit_of(BuildPhase phase) {
  if (phase == BuildPhase::kReading) return "bytes";
  return phase == BuildPhase::kWriting ? "pages" : "parts";
}

/// The phase's key in JSON, such as "matching_edges".
std::string key_of(BuildPhase phase) {
  std::string key = name_of(phase);
  std::replace(key.begin(), key.end(), ' ', '_');
  return key;
}

/// Shows the progress of the build. Records the time of each phase and the file of a failure.
class BuildMeter {
 public:
  BuildMeter(const BuildArguments& arguments, Console& console)
      : arguments_(arguments), console_(console), progress_(arguments.quiet, arguments.json) {}

  /// The options of the build, with this as observer. This must outlive them.
  BuildOptions observed_options() {
    BuildOptions options = arguments_.options;
    options.on_progress = [this](BuildPhase phase, std::uint64_t done, std::uint64_t total) {
      show(phase, done, total);
      return true;
    };
    options.on_resume = [this](const std::string& line) {
      if (!arguments_.quiet)
        console_.note(fmt::format("planetree: {}: {}\n", arguments_.output.string(), line));
    };
    options.on_failure = [this](const fs::path& path) { failed_at_ = path; };
    return options;
  }
  void finish() {
    note_seconds();
    progress_.finish();
  }

  /// Seconds by phase, in the order of phases.
  const nlohmann::ordered_json& seconds() const { return seconds_; }
  const fs::path& failed_at() const { return failed_at_; }

 private:
  void show(BuildPhase phase, std::uint64_t done, std::uint64_t total) {
    if (phase != phase_) {
      note_seconds();
      phase_ = phase;
      done_ = 0;
      progress_.start(name_of(phase), total, unit_of(phase));
    }
    if (done > done_) progress_.add(done - done_);
    done_ = std::max(done, done_);
  }
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
  std::optional<BuildPhase> phase_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
  nlohmann::ordered_json seconds_ = nlohmann::ordered_json::object();
  std::uint64_t done_ = 0;
};

void warn_of_skipped(const BuildArguments& arguments, const BuildReport& report, Console& console) {
  if (report.skipped == 0) return;
  console.warn(arguments.input.string(),
               fmt::format("{} triangle{} of bad records skipped, the first: {}; repair the "
                           "mesh, or use --strict to refuse it",
                           grouped_count(report.skipped), report.skipped == 1 ? "" : "s",
                           report.first_skipped_text));
}

void warn_of_odd_polygons(const BuildArguments& arguments, const BuildReport& report,
                          Console& console) {
  const auto polygons = [](std::uint64_t count) {
    return fmt::format("{} polygon{}", grouped_count(count), count == 1 ? "" : "s");
  };
  if (report.nonplanar_polygons > 0)
    console.warn(arguments.input.string(),
                 fmt::format("{} neither convex nor flat split as seen along an axis, the first: "
                             "{}; split them before the export to choose their triangles",
                             polygons(report.nonplanar_polygons), report.first_nonplanar_text));
  if (report.fanned_polygons > 0)
    console.warn(arguments.input.string(),
                 fmt::format("{} split into fans that may reach beyond them, the first: {}; split "
                             "them before the export",
                             polygons(report.fanned_polygons), report.first_fanned_text));
}

std::string page_size_complaint(std::uint64_t bytes) {
  if (std::has_single_bit(bytes) && bytes >= BuildOptions::kMinPageBytes &&
      bytes <= BuildOptions::kMaxPageBytes)
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

Box box_of(const std::string& text) {
  std::array<double, 6> v{};
  parse_coordinates(text, v);
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

std::string meta_complaint(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0) return {};
  return fmt::format("'{}' is not KEY=TEXT, such as title=Statue", octree::printable(text));
}

// --unit, --up, --crs and --meta.
void add_metadata(SubcommandOptions& subcommand, Metadata& metadata,
                  std::vector<std::string>& others) {
  const auto accept = [](const std::string&) { return std::string(); };
  const auto set = [&metadata](const char* key) {
    return [&metadata, key](const std::string& text) { metadata[key] = text; };
  };
  subcommand.text("--unit", "UNIT", accept, set("unit"),
                  "Unit of length of the mesh, such as mm, m or ft, which the file states. No "
                  "answer depends on it");
  subcommand.word("--up", {"x", "y", "z", "-x", "-y", "-z"}, set("up"),
                  "Axis that points up, which the file states. No answer depends on it");
  subcommand.text("--crs", "CRS", accept, set("crs"),
                  "Coordinate reference system of the mesh, such as EPSG:25832, which the file "
                  "states. No answer depends on it");
  subcommand.texts("--meta", "KEY=TEXT", meta_complaint, others,
                   "Further text that the file states, such as title, description, licence or "
                   "source; it may be given several times. generator= without a text leaves out "
                   "the program's name and version");
}

std::string memory_complaint(std::uint64_t bytes) {
  constexpr std::uint64_t kMin = BuildOptions::kMinMemoryBytes;
  if (bytes == 0 || bytes >= kMin) return {};
  return fmt::format("--memory: {} is too little for a build; give {}M or more", bytes, kMin >> 20);
}

}  // namespace

int run_build(const BuildArguments& arguments, Console& console) {
  const auto started = std::chrono::steady_clock::now();
  BuildMeter meter(arguments, console);
  const auto report = build(arguments.input, arguments.output, meter.observed_options());
  meter.finish();
  if (!report) return console.fail(meter.failed_at().string(), report.error());
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  const double seconds = std::max(elapsed.count(), 1e-9);
  for (const std::string& note : report->notes) console.warn(arguments.input.string(), note);
  warn_of_skipped(arguments, *report, console);
  warn_of_odd_polygons(arguments, *report, console);
  const BuildRecord record{arguments.input, arguments.output, arguments.options,
                           *report,         seconds,          meter.seconds()};
  if (!arguments.json) {
    console.print(plain_report(record));
    return console.finish(kDone);
  }
  const auto sha256 = sha256_of_file(arguments.output);
  if (!sha256) return console.fail(arguments.output.string(), sha256.error());
  console.print(json_report(record, *sha256));
  return console.finish(kDone);
}

void add_build(CLI::App& app, Console& console, std::function<int()>& action) {
  struct Options {
    BuildArguments arguments;
    std::uint64_t threads = 0;
    std::uint64_t page_bytes = BuildOptions{}.page_bytes;
    std::vector<std::string> metadata;
  };
  const auto options = std::make_shared<Options>();
  BuildArguments& arguments = options->arguments;
  SubcommandOptions subcommand(app, "build", "Build the .ptree file of a mesh");
  subcommand.require(
      subcommand.path("input", "IN", arguments.input,
                      "Mesh to read: PLY, STL or OFF (ascii or binary), glTF or GLB, "
                      "or OBJ, as it is or compressed by gzip or zstd"));
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
  subcommand.path(
      "--temp-dir", "DIR", arguments.options.temp_directory,
      "Directory for temporary files; by default that of the output. They take about "
      "120 bytes a triangle if memory is short, or 200 with double coordinates. The content of a "
      "compressed mesh takes its length. They have no names and vanish with the process, except "
      "for the checkpoint of --resume. The build does not begin if space is too short");
  subcommand.text(
      "--box", "X0,Y0,Z0,X1,Y1,Z1", box_complaint,
      [&arguments](const std::string& text) { arguments.options.box = box_of(text); },
      "Build only the triangles that touch this box, in model units. Sides and watertightness are "
      "those of the whole mesh. Answers are exact where the surface is nearer than the box's "
      "walls; intervals hold everywhere. Sides are known within the box");
  static const std::map<std::string, SideChoice> choices = {{"auto", SideChoice::kAuto},
                                                            {"solid", SideChoice::kSolid},
                                                            {"surface", SideChoice::kSurface}};
  subcommand.default_text(
      subcommand.word(
          "--side", {"auto", "solid", "surface"},
          [&arguments](const std::string& name) { arguments.options.side = choices.at(name); },
          "How queries decide sides by default. solid: by the winding number; surface: an open "
          "sheet "
          "such as a terrain has a front and a back, and the nearest face, edge or vertex decides; "
          "auto: surface if the mesh is not watertight and the sum of its area vectors is at least "
          "0.375 of its area"),
      "auto");
  add_layers(
      subcommand, arguments.options.layers,
      "Build only these layers of the file: distance (always built), side (sides of solids), "
      "field (answers within an error, and degraded ones), with commas between them. What is "
      "left out cannot be opened; sides of solids are unknown without side");
  const KeepOptions keep =
      add_keep(subcommand, arguments.options.keep, arguments.options.value_property);
  subcommand.flag(
      "--resume", arguments.options.resume,
      "Keep a checkpoint in the directory OUT.ptree.work, next to the output or in --temp-dir, "
      "until the file is complete. Resume from the checkpoint of an interrupted build with "
      "--resume of the same input and options. The file does not depend on it");
  subcommand.default_text(
      subcommand.bytes("--page-size", options->page_bytes,
                       "Bytes of a page in memory: a power of two from 4K to 256K"),
      "64K");
  subcommand.flag(
      "--float64", arguments.options.float64,
      "Read coordinates that an ascii PLY declares as floats as doubles, with all their "
      "digits. The file is larger then");
  add_metadata(subcommand, arguments.options.metadata, options->metadata);
  subcommand.flag("--strict", arguments.options.strict,
                  "Refuse a mesh with bad records (a vertex that is not finite, an index out of "
                  "range, fewer than 3 corners) instead of skipping them");
  subcommand.flag("--force", arguments.options.replace, "Replace the output if it exists");
  subcommand.flag("--json", arguments.json,
                  "Report as one JSON object; progress as JSON lines, on standard error");
  subcommand.flag("--quiet", arguments.quiet, "Show no progress");
  subcommand.on_given([options, keep, &console, &action] {
    options->arguments.options.threads = static_cast<unsigned>(options->threads);
    options->arguments.options.page_bytes = static_cast<std::uint32_t>(options->page_bytes);
    for (const std::string& text : options->metadata) {
      const std::size_t equals = text.find('=');
      options->arguments.options.metadata[text.substr(0, equals)] = text.substr(equals + 1);
    }
    action = [options, &console] { return run_build(options->arguments, console); };
    for (const std::string& complaint : {page_size_complaint(options->page_bytes),
                                         memory_complaint(options->arguments.options.memory_bytes),
                                         keep.complaint(options->arguments.options.keep)})
      if (!complaint.empty()) return complaint;
    return std::string();
  });
}

}  // namespace planetree::tools
