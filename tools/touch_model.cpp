#include "tools/touch_model.h"

#include <chrono>
#include <utility>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/cli/layer_option.h"
#include "tools/cli/open_model.h"
#include "tools/session/session.h"
#include "tools/session/session_trace.h"
#include "tools/simulation/simulated_session.h"
#include "tools/simulation/trace_budget.h"

namespace planetree::tools {
namespace {

OpenOptions options_of(const TouchArguments& arguments) {
  OpenOptions options;
  options.memory_budget_bytes = arguments.memory_bytes;
  options.layers = arguments.layers;
  options.policy = arguments.policy;
  options.use_io_uring = !arguments.no_io_uring;
  arguments.source.apply_to(options);
  options.max_probes = 1;
  return options;
}

// Notes what the model tells of the session.
void set_figures(const Model& model, TouchOutcome& outcome) {
  outcome.stats = model.stats();
  outcome.read_error = model.read_error();
}

/// Runs the session on the real disk, in real time.
Result<TouchOutcome> run_real(const TouchArguments& arguments, std::span<const Vec3> path,
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
  TouchOutcome outcome;
  TouchTool tool(PathBox::of(model->info()), arguments.radius);
  if (!writer) {
    outcome.record = run_touch_session(*probe, tool, path, period, parts_told(*model));
    set_figures(*model, outcome);
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
  set_figures(*model, outcome);
  return outcome;
}

/// Runs the session on a simulated disk and clock.
Result<TouchOutcome> run_simulated(const TouchArguments& arguments, std::span<const Vec3> path,
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
  TouchOutcome outcome;
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

Result<std::vector<Vec3>> find_model_path(const TouchArguments& arguments, Console& console) {
  OpenOptions options = options_of(arguments);
  options.layers = kAllLayers;
  const auto model = open_model(arguments.file, options, console);
  if (!model) return model.error();
  auto probe = Probe::create(*model);
  if (!probe) return probe.error();
  return touch_path(*model, *probe, arguments.motion, arguments.seconds * arguments.rate_hz,
                    arguments.seed);
}

Result<TouchOutcome> run_model_session(const TouchArguments& arguments, std::span<const Vec3> path,
                                       std::optional<TraceWriter>& writer) {
  return arguments.is_deterministic ? run_simulated(arguments, path, writer)
                                    : run_real(arguments, path, writer);
}

}  // namespace planetree::tools
