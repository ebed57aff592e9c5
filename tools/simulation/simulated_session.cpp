#include "tools/simulation/simulated_session.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "octree/geometry/fp_environment.h"
#include "query/model_state.h"
#include "query/probe_state.h"
#include "query/serve/fetch_threads.h"
#include "tools/cli/layer_option.h"
#include "tools/session/session_trace.h"
#include "tools/simulation/trace_budget.h"

namespace planetree::tools {
namespace {

// The clock of the session that this thread runs: the worker takes a function without context.
thread_local const SimulatedClock* running_clock = nullptr;

query::FetchWorker::Seconds simulated_time() {
  return std::chrono::nanoseconds(running_clock ? running_clock->now_ns() : 0);
}

std::uint64_t time_of(const void* clock) noexcept {
  return static_cast<const SimulatedClock*>(clock)->now_ns();
}

}  // namespace

Result<std::unique_ptr<SimulatedSession>> SimulatedSession::open(const SimulationOptions& options) {
  std::unique_ptr<SimulatedSession> session(new SimulatedSession(options));
  if (const auto opened = session->open_model(); !opened) return opened.error();
  return session;
}

SimulatedSession::SimulatedSession(const SimulationOptions& options)
    : options_(options),
      period_(std::chrono::nanoseconds(std::chrono::seconds(1)) /
              static_cast<std::int64_t>(options.rate_hz)) {}

SimulatedSession::~SimulatedSession() = default;

Result<void> SimulatedSession::open_model() {
  OpenOptions options;
  options.memory_budget_bytes = options_.memory_bytes;
  options.max_probes = 1;
  options.policy = options_.policy;
  options.layers = options_.layers;
  options.locking = Locking::kNever;
  options.page_trace_capacity = kTraceWords;
  const auto budget = budget_with_trace(options_.file, options);
  if (!budget) return budget.error();
  options.memory_budget_bytes = *budget;
  query::ModelSeams seams{disk_, false};
  seams.trace_time = {&time_of, &clock_};
  auto model = query::ModelState::open_model(options_.file, options, seams);
  if (!model) return model.error();
  model_.emplace(std::move(*model));
  const query::ModelState& state = query::ModelState::of(*model_);
  if (!state.serving().arena.traces->has_open)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "opening the model looks up more pages than a trace has room for; use a "
                      "smaller model");
  auto probe = Probe::create(*model_);
  if (!probe) return probe.error();
  probe_.emplace(std::move(*probe));
  tool_.emplace(PathBox::of(model_->info()), options_.radius);
  auto reader = state.claim_reader();
  if (!reader) return reader.error();
  worker_ = std::make_unique<query::FetchWorker>(
      state.serving().arena.fetch_requests,
      std::make_unique<query::QueryingFetchProbe>(state.serving(), std::move(*reader)), 0, 1,
      &simulated_time, never_);
  query_options_ = {.parts = parts_told(*model_), .wait = options_.wait};
  drained_.resize(4096);
  return {};
}

TraceHeader SimulatedSession::trace_header() const {
  TraceHeader header =
      trace_header_of(*model_, options_.file, options_.memory_bytes, options_.policy);
  header.rate_hz = options_.rate_hz;
  header.latency_ns = options_.latency_ns;
  header.fetch_threads = 1;
  header.is_deterministic = true;
  return header;
}

SimulatedRecord SimulatedSession::run(std::span<const Vec3> path, const Sink& sink) {
  const octree::FpEnvironmentGuard host;  // for the worker
  const SimulatedClock* const outer_clock = std::exchange(running_clock, &clock_);
  path_ = path;
  sink_ = &sink;
  record_.ticks.reserve(path.size());
  drain();
  // One query before the ticks, as in real sessions.
  if (!path.empty()) tool_->begin(*probe_, path.front(), query_options_);
  disk_.on_read([this] { wait_for_disk(); });
  run_ticks();
  disk_.on_read({});
  drain();
  const std::uint64_t served = record_.stats.fetch_requests_served;
  record_.stats = model_->stats();
  record_.stats.fetch_requests_served = served;
  record_.stats.pages_prefetched = worker_->pages_prefetched();
  running_clock = outer_clock;
  return std::move(record_);
}

void SimulatedSession::run_ticks() {
  while (record_.ticks.size() < path_.size()) {
    if (options_.wait == Wait::kForPages || due_ns(record_.ticks.size()) <= next_look_ns_)
      run_tick();
    else
      let_worker_act();
  }
}

std::uint64_t SimulatedSession::due_ns(std::size_t tick) const {
  return tick * static_cast<std::uint64_t>(period_.count());
}

// Each event has a time of its own, so that the records of the trace are in order.
void SimulatedSession::begin_event(std::uint64_t time_ns) {
  clock_.pass_until(time_ns);
  query::ModelState::of(*model_).serving().arena.traces->clock.tick();
}

void SimulatedSession::run_tick() {
  const std::size_t tick = record_.ticks.size();
  begin_event(due_ns(tick));
  const Vec3& at = path_[tick];
  if (options_.tells_motion) probe_->motion(at, velocity_at(path_, tick, period_));
  record_.ticks.push_back(Tick::of(tool_->move(*probe_, at, query_options_)));
  drain();
}

void SimulatedSession::run_ticks_before(std::uint64_t time_ns) {
  while (record_.ticks.size() < path_.size() && due_ns(record_.ticks.size()) < time_ns) run_tick();
}

// A page arrives after the latency. Ticks are due while the worker waits, but not while a query
// does.
void SimulatedSession::wait_for_disk() {
  const std::uint64_t arrival_ns = clock_.now_ns() + options_.latency_ns;
  if (options_.wait == Wait::kNever) run_ticks_before(arrival_ns);
  clock_.pass_until(arrival_ns);
}

void SimulatedSession::let_worker_act() {
  using Action = query::FetchWorker::Action;
  begin_event(next_look_ns_);
  const Action action = worker_->work();
  record_.stats.fetch_requests_served += action == Action::kServedRequest;
  if (action != Action::kNone) {
    last_action_ns_ = clock_.now_ns();
    next_look_ns_ = last_action_ns_ + kActionNs;
    return;
  }
  const auto pause =
      query::FetchThreads::pause_after(std::chrono::nanoseconds(clock_.now_ns() - last_action_ns_));
  next_look_ns_ =
      clock_.now_ns() + static_cast<std::uint64_t>(std::chrono::nanoseconds(pause).count());
}

void SimulatedSession::drain() {
  for (std::size_t count = drained_.size(); count == drained_.size();) {
    count = model_->drain_page_trace(drained_);
    const auto accesses = std::span(drained_).first(count);
    for (const PageAccess& access : accesses) record_.prefetch.add(access);
    if (*sink_ && count > 0) (*sink_)(accesses);
  }
}

}  // namespace planetree::tools
