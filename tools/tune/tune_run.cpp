#include "tools/tune/tune_run.h"

#include <algorithm>
#include <array>
#include <utility>

#include "planetree/model.h"
#include "tools/cli/policy_option.h"
#include "tools/trace_file/trace_reader.h"
#include "tools/tune/policy_replay.h"

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kDefaultLatencyNs = 85'000;
constexpr std::uint32_t kDefaultRateHz = 1000;

/// The goal if there is none: the felt budgets are measured all the same.
constexpr TuneGoal kNoGoal{TuneGoal::Quantity::kDegraded, 0.001};

Error refusal(ErrorCode code, const char* text) {
  return make_error(code, Error::kNowhere, Error::kNowhere, "%s", text);
}

/// What the sessions of a budget come to together.
FeltFigures sum_of(const std::vector<FeltFigures>& sessions) {
  FeltFigures sum;
  for (const FeltFigures& figures : sessions) {
    sum.ticks += figures.ticks;
    sum.degraded += figures.degraded;
    sum.misses += figures.misses;
    sum.width_p99 = std::max(sum.width_p99, figures.width_p99);
    sum.ticks_to_exact_p99 = std::max(sum.ticks_to_exact_p99, figures.ticks_to_exact_p99);
    sum.longest_run = std::max(sum.longest_run, figures.longest_run);
  }
  return sum;
}

}  // namespace

/// The named model, or that of the traces: as it was recorded, or beside the first trace.
fs::path TuneRun::model_path() const {
  if (!arguments_.model.empty()) return arguments_.model;
  const fs::path named = headers_.front().model;
  std::error_code none;
  if (named.empty() || fs::exists(named, none)) return named;
  const fs::path beside = arguments_.traces.front().parent_path() / named.filename();
  return fs::exists(beside, none) ? beside : fs::path();
}

TuneRun::Outcome TuneRun::read() {
  progress_.start("reading traces", 0, "records");
  for (const fs::path& trace : arguments_.traces)
    if (auto failed = read_trace(trace)) return failed;
  const TraceHeader& header = headers_.front();
  record_.recorded_policy = name_of(header.policy);
  record_.recorded_memory_bytes = header.memory_bytes;
  record_.page_bytes = header.page_bytes;
  record_.model_pages = header.pages;
  record_.timeline = analyses_.front().timeline();
  if (record_.lookups > 0) return {};
  return Failure{
      arguments_.traces.front().string(),
      refusal(ErrorCode::kBadInput, "no query looked up a page; record a longer session")};
}

TuneRun::Outcome TuneRun::read_trace(const fs::path& path) {
  const auto fail = [&](const Error& error) { return Failure{path.string(), error}; };
  auto reader = TraceReader::open(path.string());
  if (!reader) return fail(reader.error());
  headers_.push_back(reader->header());
  const TraceHeader& first = headers_.front();
  const TraceHeader& header = headers_.back();
  if (!std::equal(std::begin(header.content_id), std::end(header.content_id),
                  std::begin(first.content_id)))
    return fail(refusal(ErrorCode::kBadInput,
                        "it is of another model than the first trace; tune each model alone"));
  TraceAnalysis& analysis = analyses_.emplace_back();
  std::array<PageAccess, 1024> accesses;
  for (;;) {
    const auto count = reader->read(accesses);
    if (!count) return fail(count.error());
    if (*count == 0) break;
    for (const PageAccess& access : std::span(accesses).first(*count)) {
      analysis.add(access);
      if (arguments_.export_format) lookups_.add(access);
    }
    progress_.add(*count);
  }
  record_.traces.push_back(path.string());
  record_.lost += reader->totals().lost;
  record_.seconds += 1e-9 * static_cast<double>(analysis.end_ns());
  record_.lookups += analysis.references().lookups();
  record_.queries += analysis.queries();
  record_.degraded += analysis.degraded();
  record_.recorded_misses += analysis.misses();
  record_.evictions += analysis.evictions();
  record_.compulsory += analysis.references().compulsory();
  record_.footprint = std::max(record_.footprint, analysis.references().footprint());
  record_.prefetch.read += analysis.prefetch().read;
  record_.prefetch.used += analysis.prefetch().used;
  record_.prefetch.evicted_unused += analysis.prefetch().evicted_unused;
  record_.prefetch.late += analysis.prefetch().late;
  record_.prefetch.missed += analysis.prefetch().missed;
  return {};
}

TuneRun::Outcome TuneRun::measure() {
  if (auto failed = open_sessions()) return failed;
  compute_curves();
  if (auto failed = replay_page_sizes()) return failed;
  return sessions_ ? replay_sessions() : Outcome();
}

void TuneRun::compute_curves() {
  progress_.start("computing curves", analyses_.size(), "traces");
  const auto sizes = curve_sizes(record_.footprint);
  for (const TraceAnalysis& analysis : analyses_) {
    MissCurves curves = miss_curves(analysis.references(), sizes);
    if (record_.curves.frames.empty())
      record_.curves = std::move(curves);
    else
      add_curves(curves, record_.curves);
    progress_.add(1);
  }
  record_.knee = knee_of(sizes, record_.curves.policies.front().misses);
}

TuneRun::Outcome TuneRun::open_sessions() {
  const fs::path model = model_path();
  if (model.empty()) {
    if (!arguments_.goal && arguments_.page_sizes.empty()) return {};
    return Failure{headers_.front().model,
                   refusal(ErrorCode::kNotFound,
                           "the model of the trace is not there; name it by "
                           "--model")};
  }
  const TraceHeader& header = headers_.front();
  FeltSessions::Options options;
  options.file = model;
  options.layers = header.layers;
  options.rate_hz = header.rate_hz > 0 ? header.rate_hz : kDefaultRateHz;
  options.latency_ns = arguments_.latency_ns   ? *arguments_.latency_ns
                       : header.latency_ns > 0 ? header.latency_ns
                                               : kDefaultLatencyNs;
  for (const TraceAnalysis& analysis : analyses_) {
    options.pages = std::max<std::uint64_t>(options.pages, analysis.pages());
    std::vector<Vec3> path;
    for (const RecordedMotion& motion : analysis.motions()) path.push_back(motion.position);
    if (!path.empty()) options.paths.push_back(std::move(path));
  }
  if (arguments_.goal && !counts_misses() && options.paths.empty())
    return Failure{arguments_.traces.front().string(),
                   refusal(ErrorCode::kBadInput,
                           "it has no motion to replay; record a session that calls Probe::motion, "
                           "or give a goal of misses")};
  record_.model = model.string();
  record_.latency_ns = options.latency_ns;
  const bool has_motion = !options.paths.empty();
  sessions_ = std::make_unique<FeltSessions>(std::move(options));
  if (const auto opened = sessions_->open(); !opened) return fail_of_model(opened.error());
  if (sessions_->content_id() != std::pair(header.content_id[0], header.content_id[1]))
    return fail_of_model(
        refusal(ErrorCode::kBadInput, "it is not the model of the trace; name that by --model"));
  record_.overhead_bytes = sessions_->overhead_bytes();
  if (!has_motion && !counts_misses() && arguments_.page_sizes.empty()) sessions_.reset();
  return {};
}

TuneRun::Outcome TuneRun::replay_page_sizes() {
  if (arguments_.page_sizes.empty()) return {};
  constexpr double kShares[] = {0.1, 0.25, 0.5, 1};
  const std::uint64_t footprint_bytes = record_.footprint * record_.page_bytes;
  for (const double share : kShares)
    record_.page_size_budgets.push_back(std::max<std::uint64_t>(
        static_cast<std::uint64_t>(share * static_cast<double>(footprint_bytes)),
        4 * record_.page_bytes));
  for (const std::uint64_t bytes : arguments_.page_sizes) {
    PageSizeRow row;
    row.page_bytes = bytes;
    row.misses.resize(record_.page_size_budgets.size(), 0);
    for (const fs::path& path : arguments_.traces) {
      PageSizeReplay replay(record_.page_bytes, bytes, sessions_->core_lower(),
                            sessions_->core_upper());
      auto reader = TraceReader::open(path.string());
      if (!reader) return Failure{path.string(), reader.error()};
      std::array<PageAccess, 1024> accesses;
      for (;;) {
        const auto count = reader->read(accesses);
        if (!count) return Failure{path.string(), count.error()};
        if (*count == 0) break;
        for (const PageAccess& access : std::span(accesses).first(*count)) replay.add(access);
      }
      const References references = replay.references();
      row.footprint = std::max(row.footprint, references.footprint());
      for (std::size_t i = 0; i < row.misses.size(); ++i)
        row.misses[i] += replayed_misses(references, EvictionPolicy::kClock,
                                         static_cast<std::uint32_t>(std::max<std::uint64_t>(
                                             record_.page_size_budgets[i] / bytes, 2)));
    }
    row.footprint_bytes = row.footprint * bytes;
    record_.page_sizes.push_back(std::move(row));
  }
  return {};
}

/// The ticks that a goal judges: those of replayed sessions, or the misses of replayed lookups.
Result<std::vector<std::vector<FeltTick>>> TuneRun::measure_goal(std::uint64_t bytes,
                                                                 EvictionPolicy policy) {
  progress_.add(1);
  if (!counts_misses()) return sessions_->measure(bytes, policy);
  const auto frames = sessions_->count_frames(bytes, policy);
  if (!frames) return frames.error();
  std::vector<std::vector<FeltTick>> sessions;
  for (const TraceAnalysis& analysis : analyses_) {
    std::vector<FeltTick>& ticks = sessions.emplace_back();
    for (const std::uint32_t misses :
         replayed_misses_by_query(analysis.references(), policy, *frames))
      ticks.push_back({false, 0, misses});
  }
  return sessions;
}

TuneRun::Outcome TuneRun::replay_sessions() {
  progress_.start("replaying sessions", 0, "budgets");
  const EvictionPolicy usual = OpenOptions().policy;
  const auto search_for = [&](EvictionPolicy policy, std::uint64_t most) {
    return MemorySearch(
        arguments_.goal.value_or(kNoGoal), sessions_->least_bytes(), most, sessions_->page_bytes(),
        [this, policy](std::uint64_t bytes) { return measure_goal(bytes, policy); });
  };
  MemorySearch search = search_for(usual, sessions_->most_bytes());
  if (!arguments_.goal) {
    if (const auto done = search.measure_grid(); !done) return fail_of_model(done.error());
    describe_felt(search, usual);
    return {};
  }
  const auto needed = search.search();
  if (!needed) return fail_of_model(needed.error());
  describe_felt(search, usual);
  TuneRecommendation best;
  best.goal = *arguments_.goal;
  best.is_kept = needed->has_value();
  const auto take = [&](const MemoryNeeded& bytes, const MemorySearch& of, EvictionPolicy policy) {
    best.policy = policy;
    best.memory_bytes = bytes.recommended;
    best.low_bytes = bytes.low;
    best.high_bytes = bytes.high;
    best.value = of.measured().at(bytes.recommended).value;
    best.frames = sessions_->frames_within(bytes.recommended, policy);
  };
  if (best.is_kept) {
    take(**needed, search, usual);
    // Another policy has to save a tenth of the memory that can be saved at all.
    for (const EvictionPolicy policy : kAllPolicies) {
      const std::uint64_t above = best.memory_bytes - sessions_->least_bytes();
      const std::uint64_t step = sessions_->page_bytes();
      if (policy == usual || above < 10 * step) continue;
      MemorySearch other = search_for(policy, best.memory_bytes - above / 10 / step * step);
      const auto saves = other.keeps_goal_with_most();
      if (!saves) return fail_of_model(saves.error());
      if (!*saves) continue;
      const auto less = other.search();
      if (!less) return fail_of_model(less.error());
      if (*less) take(**less, other, policy);
    }
  }
  record_.recommended = best;
  return {};
}

void TuneRun::describe_felt(const MemorySearch& search, EvictionPolicy policy) {
  if (counts_misses()) return;
  for (const auto& [bytes, measured] : search.measured())
    record_.felt.push_back({bytes, sessions_->frames_within(bytes, policy),
                            sum_of(measured.sessions), measured.value});
}

}  // namespace planetree::tools
