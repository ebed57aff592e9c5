#include "tools/touch.h"

#include <fcntl.h>
#include <unistd.h>

#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/cli/duration_text.h"
#include "tools/cli/layer_option.h"
#include "tools/cli/open_model.h"
#include "tools/cli/output_file.h"
#include "tools/cli/policy_option.h"
#include "tools/cli/subcommand_options.h"
#include "tools/session/session.h"
#include "tools/session/session_report.h"
#include "tools/session/session_ticks.h"
#include "tools/session/session_trace.h"
#include "tools/session/touch_page.h"
#include "tools/simulation/simulated_session.h"
#include "tools/simulation/trace_budget.h"
#include "tools/trace_file/trace_writer.h"

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
  return options;
}

/// Finds the tip's path with a model of its own, so that it leaves no page in the session's memory.
/// That model has all layers, so that the path does not depend on those of the session.
Result<std::vector<Vec3>> find_path(const TouchArguments& arguments, Console& console) {
  OpenOptions options = options_of(arguments);
  options.layers = kAllLayers;
  const auto model = open_model(arguments.file, options, console);
  if (!model) return model.error();
  auto probe = Probe::create(*model);
  if (!probe) return probe.error();
  return touch_path(*model, *probe, arguments.motion, arguments.seconds * arguments.rate_hz,
                    arguments.seed);
}

/// Opens an additional output file, if `path` names one. Opened before the session, which may be
/// long, so that the command fails early.
template <class File>
Result<std::optional<File>> open_extra_output(const std::filesystem::path& path, bool force) {
  if (path.empty()) return std::optional<File>();
  auto file = File::create(path, force);
  if (!file) return file.error();
  return std::optional<File>(std::move(*file));
}

Result<void> write_whole(OutputFile& file, const std::string& text) {
  if (const auto written = file.write(std::as_bytes(std::span(text))); !written) return written;
  return file.commit();
}

/// What a session comes to.
struct Outcome {
  TouchRecord record;
  Stats stats;
  std::optional<PrefetchFigures> prefetch;  ///< if there was a trace
  Result<void> trace_written;               ///< whether the trace file is complete
};

/// Runs the session on the real disk, in real time.
Result<Outcome> run_real(const TouchArguments& arguments, std::span<const Vec3> path,
                         std::optional<TraceWriter>& writer) {
  OpenOptions options = options_of(arguments);
  options.read_ahead = arguments.read_ahead;
  if (writer) {
    options.page_trace_capacity = DrainThread::kTraceWords;
    const auto budget = budget_with_trace(arguments.file, options);
    if (!budget) return budget.error();
    options.memory_budget_bytes = *budget;
  }
  const auto model = Model::open(arguments.file, options);
  if (!model) return model.error();
  auto probe = Probe::create(*model);
  if (!probe) return probe.error();
  const auto period = std::chrono::nanoseconds(std::chrono::seconds(1)) /
                      static_cast<std::int64_t>(arguments.rate_hz);
  Outcome outcome;
  TouchTool tool(*model, arguments.radius);
  if (!writer) {
    outcome.record = run_touch_session(*probe, tool, path, period, parts_told(*model));
    outcome.stats = model->stats();
    return outcome;
  }
  TraceHeader header =
      trace_header_of(*model, arguments.file, arguments.memory_bytes, arguments.policy);
  header.rate_hz = static_cast<std::uint32_t>(arguments.rate_hz);
  header.fetch_threads = static_cast<std::uint16_t>(options.fetch_threads);
  outcome.trace_written = writer->begin(header);
  TraceRecorder recorder(*model, *writer);
  {
    const DrainThread drain(recorder);
    outcome.record = run_touch_session(*probe, tool, path, period, parts_told(*model));
  }
  if (outcome.trace_written) outcome.trace_written = recorder.finish(path.size());
  outcome.prefetch = recorder.prefetch();
  outcome.stats = model->stats();
  return outcome;
}

/// Runs the session on a simulated disk and clock.
Result<Outcome> run_simulated(const TouchArguments& arguments, std::span<const Vec3> path,
                              std::optional<TraceWriter>& writer) {
  SimulationOptions options;
  options.file = arguments.file;
  options.memory_bytes = arguments.memory_bytes;
  options.policy = arguments.policy;
  options.layers = arguments.layers;
  options.rate_hz = static_cast<std::uint32_t>(arguments.rate_hz);
  options.latency_ns = arguments.latency_ns;
  options.radius = arguments.radius;
  auto session = SimulatedSession::open(options);
  if (!session) return session.error();
  Outcome outcome;
  if (writer) outcome.trace_written = writer->begin((*session)->trace_header());
  SimulatedRecord record = (*session)->run(path, [&](std::span<const PageAccess> accesses) {
    if (writer && outcome.trace_written) outcome.trace_written = writer->add(accesses);
  });
  if (writer && outcome.trace_written)
    outcome.trace_written = writer->finish(path.size(), record.stats.page_trace_dropped);
  outcome.record.ticks = std::move(record.ticks);
  outcome.prefetch = std::move(record.prefetch);
  outcome.stats = record.stats;
  return outcome;
}

}  // namespace

int run_touch(const TouchArguments& arguments, Console& console) {
  const std::string file = arguments.file.string();
  ReportPage page(arguments.page, console);
  if (const int status = page.open(std::span(&arguments.file, 1)); status != kDone) return status;
  auto ticks = open_extra_output<OutputFile>(arguments.ticks, arguments.page.force);
  if (!ticks) return console.fail(arguments.ticks.string(), ticks.error());
  auto trace = open_extra_output<TraceWriter>(arguments.trace, arguments.page.force);
  if (!trace) return console.fail(arguments.trace.string(), trace.error());
  const auto path = find_path(arguments, console);
  if (!path) return console.fail(file, path.error());
  if (arguments.cold) drop_from_page_cache(arguments.file);

  const auto outcome = arguments.is_deterministic ? run_simulated(arguments, *path, *trace)
                                                  : run_real(arguments, *path, *trace);
  if (!outcome) return console.fail(file, outcome.error());
  const PrefetchFigures* const prefetch = outcome->prefetch ? &*outcome->prefetch : nullptr;
  const TouchRecord& record = outcome->record;
  const std::string text = arguments.json
                               ? touch_json(arguments, record, outcome->stats, prefetch)
                               : touch_words(arguments, record, outcome->stats, prefetch);
  const int reported = page.report(text, [&] {
    return touch_page(arguments, record, outcome->stats, prefetch, touch_command(arguments));
  });
  if (reported != kDone) return console.finish(reported);
  if (*ticks)
    if (const auto written = write_whole(**ticks, touch_ticks(*path, record)); !written)
      return console.finish(console.fail(arguments.ticks.string(), written.error()));
  if (!outcome->trace_written)
    return console.finish(console.fail(arguments.trace.string(), outcome->trace_written.error()));
  const auto error = pages_lost(outcome->stats);
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
  const auto is_ball = std::make_shared<bool>(false);
  subcommand.default_text(
      subcommand.word(
          "--tool", {"point", "sphere"},
          [is_ball](const std::string& name) { *is_ball = name == "sphere"; },
          "point: asks for its nearest point; sphere: a ball of --radius that follows the path, "
          "passes through no wall and slides along the surface, by up to three first contacts a "
          "tick"),
      "point");
  subcommand.length("--radius", options->radius, false,
                    "With --tool sphere: radius of the ball, in model units");
  add_policy(subcommand, options->policy);
  add_open_layers(subcommand, options->layers);
  subcommand.path("--ticks", "OUT.csv", options->ticks,
                  "Write all ticks here: tick,x,y,z,latency_us,query_us,width,side,status");
  subcommand.path(
      "--trace", "OUT.trace", options->trace,
      "Write the page trace of the session here, in the format of "
      "format-spec/trace-v1/spec.md: page lookups, pages read and evicted, motions. Its "
      "memory comes on top of --memory");
  subcommand.flag("--deterministic", options->is_deterministic,
                  "Simulate disk and clock: the session depends on the file and these options "
                  "alone, to the bit, and takes less time. Nothing of the machine is reported");
  const auto complaint = [](const std::string& text) -> std::string {
    const auto latency = parse_latency(text);
    return latency ? std::string() : std::string(latency.error().text);
  };
  const auto take = [options](const std::string& text) {
    options->latency_ns = *parse_latency(text);
    options->latency_is_given = true;
  };
  subcommand.default_text(
      subcommand.text("--latency", "TIME", complaint, take,
                      "With --deterministic: time in which the disk reads a page, such as 85us"),
      "85us");
  subcommand.default_text(
      subcommand.count("--seed", options->seed, std::numeric_limits<std::uint64_t>::max(),
                       "Choose another path of the same kind"),
      "20");
  add_page_path(subcommand, options->page);
  subcommand.flag("--force", options->page.force,
                  "Replace the files of --ticks, --trace and --html if they exist");
  subcommand.flag(
      "--cold", options->cold,
      "Drop the file from the system's page cache first, so that every page comes from the disk");
  subcommand.flag("--no-io-uring", options->no_io_uring,
                  "Do not wait for pages by io_uring but poll for them: for systems that end a "
                  "process that tries");
  subcommand.flag("--read-ahead", options->read_ahead,
                  "Read all pages while there is nothing else to do, if memory holds all of them");
  subcommand.flag("--json", options->json, "Report as one JSON object");
  subcommand.on_given([options, is_ball, &console, &action]() -> std::string {
    if (*is_ball != (options->radius > 0))
      return *is_ball ? "--tool sphere needs a --radius above 0"
                      : "--radius is that of a ball; add --tool sphere";
    if (options->trace == "-" || options->ticks == "-")
      return "--ticks and --trace need files; standard output is for the report";
    if (options->is_deterministic && (options->cold || options->no_io_uring || options->read_ahead))
      return "--deterministic reads no real disk; omit --cold, --no-io-uring and --read-ahead";
    if (options->latency_is_given && !options->is_deterministic)
      return "--latency is that of a simulated disk; add --deterministic";
    if (options->seconds == 0 || options->rate_hz == 0)
      return "the session has no ticks; give --seconds and --rate of 1 or more";
    action = [options, &console] { return run_touch(*options, console); };
    return {};
  });
}

}  // namespace planetree::tools
