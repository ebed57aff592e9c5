#include "tools/touch.h"

#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/cli/layer_option.h"
#include "tools/cli/open_model.h"
#include "tools/cli/output_file.h"
#include "tools/cli/policy_option.h"
#include "tools/cli/subcommand_options.h"
#include "tools/session/session.h"
#include "tools/session/session_report.h"
#include "tools/session/session_ticks.h"
#include "tools/session/session_trace.h"

namespace planetree::tools {
namespace {

constexpr std::uint64_t kMaxSeconds = 86400, kMaxRateHz = 100000;

/// Drops the file from the system's page cache, so that every page comes from the disk.
void drop_from_page_cache(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  ::posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
  ::close(file);
}

OpenOptions options_of(const TouchArguments& arguments) {
  OpenOptions options;
  options.memory_budget_bytes = arguments.memory_bytes;
  options.layers = arguments.layers;
  options.policy = arguments.policy;
  options.use_io_uring = !arguments.no_io_uring;
  options.max_probes = 1;
  if (!arguments.trace.empty()) options.page_trace_capacity = PageTraceDrain::kAccessesWaiting;
  return options;
}

/// Finds the tip's path with a model of its own, so that it leaves no page in the session's memory.
/// That model has all layers, so that the path does not depend on those of the session.
Result<std::vector<Vec3>> find_path(const TouchArguments& arguments, Console& console) {
  OpenOptions options = options_of(arguments);
  options.page_trace_capacity = 0;
  options.layers = kAllLayers;
  const auto model = open_model(arguments.file, options, console);
  if (!model) return model.error();
  auto probe = Probe::create(*model);
  if (!probe) return probe.error();
  return touch_path(*model, *probe, arguments.motion, arguments.seconds * arguments.rate_hz);
}

/// Opens an additional output file, if `path` names one. Opened before the session, which may be
/// long, so that the command fails early.
Result<std::optional<OutputFile>> open_extra_output(const std::filesystem::path& path, bool force) {
  if (path.empty()) return std::optional<OutputFile>();
  auto file = OutputFile::create(path, force);
  if (!file) return file.error();
  return std::optional<OutputFile>(std::move(*file));
}

Result<void> write_whole(OutputFile& file, const std::string& text) {
  if (const auto written = file.write(std::as_bytes(std::span(text))); !written) return written;
  return file.commit();
}

}  // namespace

int run_touch(const TouchArguments& arguments, Console& console) {
  const std::string file = arguments.file.string();
  auto ticks = open_extra_output(arguments.ticks, arguments.force);
  if (!ticks) return console.fail(arguments.ticks.string(), ticks.error());
  auto trace = open_extra_output(arguments.trace, arguments.force);
  if (!trace) return console.fail(arguments.trace.string(), trace.error());
  const auto path = find_path(arguments, console);
  if (!path) return console.fail(file, path.error());
  if (arguments.cold) drop_from_page_cache(arguments.file);

  const auto model = Model::open(arguments.file, options_of(arguments));
  if (!model) return console.fail(file, model.error());
  auto probe = Probe::create(*model);
  if (!probe) return console.fail(file, probe.error());
  const auto period = std::chrono::nanoseconds(std::chrono::seconds(1)) /
                      static_cast<std::int64_t>(arguments.rate_hz);
  std::optional<PageTraceDrain> drain;
  if (*trace) drain.emplace(*model);
  const TouchRecord record = run_touch_session(*probe, *path, period, parts_told(*model));
  const std::string trace_text = drain ? touch_trace(drain->finish()) : "";
  console.print(arguments.json ? touch_json(arguments, record, *model)
                               : touch_words(arguments, record, *model));
  if (*ticks)
    if (const auto written = write_whole(**ticks, touch_ticks(*path, record)); !written)
      return console.finish(console.fail(arguments.ticks.string(), written.error()));
  if (*trace)
    if (const auto written = write_whole(**trace, trace_text); !written)
      return console.finish(console.fail(arguments.trace.string(), written.error()));
  const auto error = pages_lost(model->stats());
  return console.finish(error ? console.fail(file, *error) : kDone);
}

void add_touch(CLI::App& app, Console& console, std::function<int()>& action) {
  static const std::map<std::string, TouchMotion> motions = [] {
    std::map<std::string, TouchMotion> named;
    for (const TouchMotion motion : kAllTouchMotions) named.emplace(name_of(motion), motion);
    return named;
  }();
  std::vector<std::string> names;
  for (const auto& [name, motion] : motions) names.push_back(name);
  const auto options = std::make_shared<TouchArguments>();
  SubcommandOptions subcommand(
      app, "touch",
      "Run a simulated haptic session and report the latency and status of its answers");
  subcommand.require(
      subcommand.path("file", "FILE", options->file, "File that planetree build wrote"));
  subcommand.default_text(
      subcommand.count("--seconds", options->seconds, kMaxSeconds, "Duration in seconds"), "10");
  subcommand.default_text(
      subcommand.count("--rate", options->rate_hz, kMaxRateHz, "Queries per second, in Hz"),
      "1000");
  subcommand.default_text(
      subcommand.bytes("--memory", options->memory_bytes, "Maximum memory for the model"), "256M");
  subcommand.default_text(
      subcommand.word(
          "--path", names,
          [options](const std::string& name) { options->motion = motions.at(name); },
          "Motion of the tip: glide (along the surface, 0.02 % of the diagonal per tick), scratch "
          "(0.1 %) or teleport (to another surface point every hundred ticks)"),
      "glide");
  add_policy(subcommand, options->policy);
  add_open_layers(subcommand, options->layers);
  subcommand.path("--ticks", "OUT.csv", options->ticks,
                  "Write all ticks here: tick,x,y,z,latency_us,query_us,width,side,status");
  subcommand.path("--trace", "OUT.csv", options->trace,
                  "Write all page accesses of the session here: tick,probe,page,level,access (hit, "
                  "prefetched or missed)");
  subcommand.flag("--force", options->force,
                  "Replace the files of --ticks and --trace if they exist");
  subcommand.flag(
      "--cold", options->cold,
      "Drop the file from the system's page cache first, so that every page comes from the disk");
  subcommand.flag("--no-io-uring", options->no_io_uring,
                  "Do not wait for pages by io_uring but poll for them: for systems that end a "
                  "process that tries");
  subcommand.flag("--json", options->json, "Report as one JSON object");
  subcommand.on_given([options, &console, &action]() -> std::string {
    if (options->trace == "-" || options->ticks == "-")
      return "--ticks and --trace need files; standard output is for the report";
    if (options->seconds == 0 || options->rate_hz == 0)
      return "the session has no ticks; give --seconds and --rate of 1 or more";
    action = [options, &console] { return run_touch(*options, console); };
    return {};
  });
}

}  // namespace planetree::tools
