#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/cli/duration_text.h"
#include "tools/cli/layer_option.h"
#include "tools/cli/policy_option.h"
#include "tools/cli/subcommand_options.h"
#include "tools/touch.h"

namespace planetree::tools {
namespace {

constexpr std::uint64_t kMaxSeconds = 86400, kMaxRateHz = 100000;

/// The command line of `planetree touch`.
struct TouchOptions {
  using Option = SubcommandOptions::Option;

  TouchArguments arguments;
  std::filesystem::path model, scene;
  bool is_ball = false;
  Option model_option = nullptr, scene_option = nullptr, memory = nullptr, latency = nullptr;
  Option layers = nullptr, trace = nullptr, read_ahead = nullptr;
};

void add_session(SubcommandOptions& subcommand, TouchOptions& options) {
  TouchArguments& arguments = options.arguments;
  options.model_option = subcommand.path("file", "FILE", options.model,
                                         "File that planetree build wrote, or a URL of one");
  options.scene_option = subcommand.path(
      "--scene", "FILE.json", options.scene,
      "Touch the models of this scene file (format-spec/scene-v1/spec.md) instead of a FILE. "
      "Instances begin where it puts them and move by its velocities");
  subcommand.default_text(
      subcommand.count("--seconds", arguments.seconds, kMaxSeconds, "Duration in seconds"), "10");
  subcommand.default_text(
      subcommand.count("--rate", arguments.rate_hz, kMaxRateHz, "Queries per second, in Hz"),
      "1000");
  options.memory = subcommand.default_text(
      subcommand.bytes("--memory", arguments.memory_bytes, "Maximum memory for the model or scene"),
      "256M, or what the scene file says");
}

void add_tool(SubcommandOptions& subcommand, TouchOptions& options) {
  static const std::map<std::string, TouchMotion> motions = [] {
    std::map<std::string, TouchMotion> named;
    for (const TouchMotion motion : kAllTouchMotions) named.emplace(name_of(motion), motion);
    return named;
  }();
  std::vector<std::string> names;
  for (const auto& [name, motion] : motions) names.push_back(name);
  subcommand.default_text(
      subcommand.word(
          "--path", names,
          [&options](const std::string& name) { options.arguments.motion = motions.at(name); },
          "Motion of the tip: glide (along the surface, 0.02 % of the diagonal per tick), scratch "
          "(0.1 %) or teleport (to another surface point every hundred ticks)"),
      "glide");
  subcommand.default_text(
      subcommand.word(
          "--tool", {"point", "sphere"},
          [&options](const std::string& name) { options.is_ball = name == "sphere"; },
          "point: asks for its nearest point; sphere: a ball of --radius that follows the path, "
          "passes through no wall and slides along the surface, by up to three first contacts a "
          "tick; it gives way to instances that move"),
      "point");
  subcommand.length("--radius", options.arguments.radius, false,
                    "With --tool sphere: radius of the ball, in model units");
}

void add_records(SubcommandOptions& subcommand, TouchOptions& options) {
  TouchArguments& arguments = options.arguments;
  add_policy(subcommand, arguments.policy);
  options.layers = add_open_layers(subcommand, arguments.layers);
  add_http_cache(subcommand, arguments.source);
  subcommand.path("--ticks", "OUT.csv", arguments.ticks,
                  "Write all ticks here: tick,x,y,z,latency_us,query_us,width,side,status and, of "
                  "a scene, the position of the nearest instance in its file");
  options.trace = subcommand.path(
      "--trace", "OUT.trace", arguments.trace,
      "Write the page trace of the session here, in the format of "
      "format-spec/trace-v1/spec.md: page lookups, pages read and evicted, motions. Its "
      "memory comes on top of --memory. Not with --scene");
}

void add_simulation(SubcommandOptions& subcommand, TouchOptions& options) {
  TouchArguments& arguments = options.arguments;
  subcommand.flag("--deterministic", arguments.is_deterministic,
                  "Simulate disk and clock: the session depends on the file and these options "
                  "alone, to the bit, and takes less time. Nothing of the machine is reported. Not "
                  "with --scene");
  const auto complaint = [](const std::string& text) -> std::string {
    const auto latency = parse_latency(text);
    return latency ? std::string() : std::string(latency.error().text);
  };
  const auto take = [&arguments](const std::string& text) {
    arguments.latency_ns = *parse_latency(text);
    arguments.latency_is_given = true;
  };
  options.latency = subcommand.default_text(
      subcommand.text("--latency", "TIME", complaint, take,
                      "With --deterministic: time in which the disk reads a page, such as 85us"),
      "85us");
}

void add_way_of_running(SubcommandOptions& subcommand, TouchOptions& options) {
  TouchArguments& arguments = options.arguments;
  subcommand.default_text(
      subcommand.count("--seed", arguments.seed, std::numeric_limits<std::uint64_t>::max(),
                       "Choose another path of the same kind"),
      "20");
  add_page_path(subcommand, arguments.page);
  subcommand.flag("--force", arguments.page.force,
                  "Replace the files of --ticks, --trace and --html if they exist");
  subcommand.flag(
      "--cold", arguments.cold,
      "Drop the file from the system's page cache first, so that every page comes from the disk");
  subcommand.flag("--no-io-uring", arguments.no_io_uring,
                  "Do not wait for pages by io_uring but poll for them: for systems that end a "
                  "process that tries");
  options.read_ahead = subcommand.flag(
      "--read-ahead", arguments.read_ahead,
      "Read all pages while there is nothing else to do, if memory holds all of them. Not with "
      "--scene");
  subcommand.flag("--json", arguments.json, "Report as one JSON object");
}

/// What is wrong with options beside --scene. Empty if nothing is.
std::string scene_complaint(const TouchOptions& options) {
  const auto given = &SubcommandOptions::given;
  if (given(options.model_option)) return "a session has a FILE or a --scene; omit one of them";
  if (given(options.layers))
    return "the scene file names the layers of each model; omit --layers and write them there";
  if (given(options.trace))
    return "a page trace is that of one model; omit --trace, or give a FILE instead of --scene";
  if (options.arguments.is_deterministic || given(options.latency))
    return "the simulated disk has one model; omit --deterministic and --latency, or give a FILE "
           "instead of --scene";
  if (given(options.read_ahead))
    return "a scene reads no pages ahead; omit --read-ahead, or give a FILE instead of --scene";
  return {};
}

std::string complaint_about(const TouchOptions& options) {
  const TouchArguments& arguments = options.arguments;
  if (arguments.is_scene) {
    if (std::string complaint = scene_complaint(options); !complaint.empty()) return complaint;
  } else if (!SubcommandOptions::given(options.model_option)) {
    return "there is nothing to touch; give a FILE that planetree build wrote, or a --scene";
  }
  if (options.is_ball != (arguments.radius > 0))
    return options.is_ball ? "--tool sphere needs a --radius above 0"
                           : "--radius is that of a ball; add --tool sphere";
  if (arguments.trace == "-" || arguments.ticks == "-")
    return "--ticks and --trace need files; standard output is for the report";
  if (arguments.is_deterministic &&
      (arguments.cold || arguments.no_io_uring || arguments.read_ahead))
    return "--deterministic reads no real disk; omit --cold, --no-io-uring and --read-ahead";
  if (arguments.latency_is_given && !arguments.is_deterministic)
    return "--latency is that of a simulated disk; add --deterministic";
  if (arguments.seconds == 0 || arguments.rate_hz == 0)
    return "the session has no ticks; give --seconds and --rate of 1 or more";
  return {};
}

}  // namespace

void add_touch(CLI::App& app, Console& console, std::function<int()>& action) {
  const auto options = std::make_shared<TouchOptions>();
  SubcommandOptions subcommand(
      app, "touch",
      "Run a simulated haptic session and report the latency and status of its answers");
  add_session(subcommand, *options);
  add_tool(subcommand, *options);
  add_records(subcommand, *options);
  add_simulation(subcommand, *options);
  add_way_of_running(subcommand, *options);
  subcommand.on_given([options, &console, &action]() -> std::string {
    TouchArguments& arguments = options->arguments;
    arguments.is_scene = SubcommandOptions::given(options->scene_option);
    arguments.file = arguments.is_scene ? options->scene : options->model;
    arguments.memory_is_given = SubcommandOptions::given(options->memory);
    action = [options, &console] { return run_touch(options->arguments, console); };
    return complaint_about(*options);
  });
}

}  // namespace planetree::tools
