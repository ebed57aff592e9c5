#include "tools/session/session_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/cli/layer_option.h"
#include "tools/cli/policy_option.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand.h"
#include "tools/session/sorted.h"
#include "tools/session/touch_instances.h"

namespace planetree::tools {
namespace {

constexpr std::pair<const char*, double> kShares[] = {
    {"p50", 0.5}, {"p99", 0.99}, {"p999", 0.999}, {"p9999", 0.9999}, {"max", 1}};

nlohmann::ordered_json in_microseconds(std::vector<std::uint32_t> nanoseconds) {
  const Sorted<std::uint32_t> sorted(std::move(nanoseconds));
  nlohmann::ordered_json shares;
  for (const auto& [name, share] : kShares) shares[name] = sorted.at(share) / 1e3;
  return shares;
}

/// What Stats has and SceneStats has not.
constexpr const char* kOfModelsAlone[] = {"layers", "fetch_requests", "pages_read_ahead",
                                          "page_trace_dropped", "locked_bytes"};

template <class Field>
std::vector<std::uint32_t> each(const TouchRecord& record, Field Tick::*field) {
  std::vector<std::uint32_t> values;
  for (const Tick& tick : record.ticks) values.push_back(tick.*field);
  return values;
}

bool is_degraded(const Tick& tick) { return tick.status == Status::kDegraded; }

/// Interval widths of the degraded ticks.
std::vector<float> widths(const TouchRecord& record) {
  std::vector<float> values;
  for (const Tick& tick : record.ticks)
    if (is_degraded(tick)) values.push_back(tick.width);
  return values;
}

/// Lengths of all runs of consecutive degraded ticks.
std::vector<std::uint32_t> refine_ticks(const TouchRecord& record) {
  std::vector<std::uint32_t> runs;
  std::uint32_t run = 0;
  for (const Tick& tick : record.ticks) {
    if (is_degraded(tick)) {
      ++run;
    } else if (run > 0) {
      runs.push_back(run);
      run = 0;
    }
  }
  if (run > 0) runs.push_back(run);
  return runs;
}

/// What no clock and no system decides.
nlohmann::ordered_json session_report(const TouchArguments& arguments,
                                      const TouchOutcome& outcome) {
  const TouchRecord& record = outcome.record;
  const Stats& stats = outcome.stats;
  // A ball does not ask for sides.
  const auto unknown_sides = std::count_if(
      record.ticks.begin(), record.ticks.end(),
      [&](const Tick& tick) { return arguments.radius == 0 && tick.side == Side::kUnknown; });
  const Sorted<float> width(widths(record));
  const Sorted<std::uint32_t> refine(refine_ticks(record));
  // The trace takes memory besides the budget.
  const std::uint64_t trace_bytes = stats.budget_bytes - arguments.memory_bytes;
  return {{"file", arguments.file.string()},
          {"path", name_of(arguments.motion)},
          {"tool", arguments.radius > 0 ? "sphere" : "point"},
          {"radius", arguments.radius},
          {"seed", arguments.seed},
          {"rate_hz", arguments.rate_hz},
          {"policy", name_of(arguments.policy)},
          {"layers", layer_words(stats.layers)},
          {"ticks", record.ticks.size()},
          {"degraded", std::count_if(record.ticks.begin(), record.ticks.end(), is_degraded)},
          {"touching", std::count_if(record.ticks.begin(), record.ticks.end(),
                                     [](const Tick& tick) { return tick.touches; })},
          {"unknown_sides", unknown_sides},
          {"refine_ticks_p50", refine.at(0.5)},
          {"refine_ticks_p99", refine.at(0.99)},
          {"refine_ticks_max", refine.at(1)},
          {"degraded_width_p50", width.at(0.5)},
          {"degraded_width_max", width.at(1)},
          {"pages_read", stats.pages_read},
          {"pages_evicted", stats.pages_evicted},
          {"quarantined_pages", stats.quarantined_pages},
          {"fetch_requests_served", stats.fetch_requests_served},
          {"fetch_requests", stats.fetch_requests},
          {"pages_prefetched", stats.pages_prefetched},
          {"pages_read_ahead", stats.pages_read_ahead},
          {"page_trace_dropped", stats.page_trace_dropped},
          {"frames", stats.frames},
          {"budget_bytes", stats.budget_bytes - trace_bytes},
          {"held_bytes", stats.arena_bytes + stats.table_bytes - trace_bytes}};
}

/// What the machine decides.
nlohmann::ordered_json machine_report(const TouchArguments& arguments,
                                      const TouchOutcome& outcome) {
  const TouchRecord& record = outcome.record;
  const std::uint64_t period_ns = 1'000'000'000 / arguments.rate_hz;
  const auto late = std::count_if(record.ticks.begin(), record.ticks.end(),
                                  [&](const Tick& tick) { return tick.latency_ns > period_ns; });
  return {{"late", late},
          {"latency_us", in_microseconds(each(record, &Tick::latency_ns))},
          {"query_us", in_microseconds(each(record, &Tick::query_ns))},
          {"floor_us", in_microseconds(record.floor_ns)},
          {"faults", record.usage.faults},
          {"voluntary_switches", record.usage.voluntary_switches},
          {"involuntary_switches", record.usage.involuntary_switches},
          {"fifo", record.rights.fifo},
          {"pinned", record.rights.pinned},
          {"locked_bytes", outcome.stats.locked_bytes},
          {"peak_resident_bytes", peak_resident_bytes()}};
}

nlohmann::ordered_json prefetch_report(const PrefetchFigures& prefetch) {
  return {{"accuracy", prefetch.accuracy()},
          {"coverage", prefetch.coverage()},
          {"timeliness", prefetch.timeliness()},
          {"waste", prefetch.waste()},
          {"read", prefetch.read},
          {"used", prefetch.used},
          {"late", prefetch.late},
          {"missed", prefetch.missed},
          {"evicted_unused", prefetch.evicted_unused}};
}

std::string row(const nlohmann::ordered_json& shares) {
  std::string text;
  for (const auto& [name, share] : kShares)
    text += fmt::format(" {:>9.1f}", shares[name].get<double>());
  return text;
}

const char* granted(bool yes) { return yes ? "granted" : "refused"; }

/// Lines about the machine.
std::string machine_words(const TouchRecord& record, const nlohmann::ordered_json& report) {
  const auto number = [&](const char* key) { return report[key].get<std::uint64_t>(); };
  std::string text = "microseconds         p50       p99     p99.9    p99.99       max\n";
  text += "latency         " + row(report["latency_us"]) + '\n';
  text += "the query alone " + row(report["query_us"]) + '\n';
  text += "idle thread     " + row(report["floor_us"]) + '\n';
  text += fmt::format("real-time priority: {}; pinned to one processor: {}",
                      granted(record.rights.fifo), granted(record.rights.pinned));
  if (report.contains("locked_bytes"))
    text += fmt::format("; memory locked: {}", granted(number("locked_bytes") > 0));
  text += '\n';
  text += fmt::format("{} page faults, {} involuntary context switches; ", number("faults"),
                      number("involuntary_switches"));
  return text;
}

}  // namespace

nlohmann::ordered_json touch_report(const TouchArguments& arguments, const TouchOutcome& outcome) {
  nlohmann::ordered_json report = session_report(arguments, outcome);
  report["deterministic"] = arguments.is_deterministic;
  if (arguments.is_deterministic)
    report["read_latency_us"] = static_cast<double>(arguments.latency_ns) / 1e3;
  else
    report.update(machine_report(arguments, outcome));
  if (outcome.prefetch) report["prefetch"] = prefetch_report(*outcome.prefetch);
  if (arguments.is_scene) {
    for (const char* const key : kOfModelsAlone) report.erase(key);
    report["instances"] = instances_json(outcome);
  }
  return report;
}

std::string touch_json(const TouchArguments& arguments, const TouchOutcome& outcome) {
  return json_line(touch_report(arguments, outcome));
}

std::string touch_words(const TouchArguments& arguments, const TouchOutcome& outcome) {
  const auto report = touch_report(arguments, outcome);
  const auto number = [&](const char* key) { return report[key].get<std::uint64_t>(); };
  std::string text =
      fmt::format("{}: {}, {} ticks at {} Hz, {} held of a budget of {}\n", arguments.file.string(),
                  name_of(arguments.motion), grouped_count(number("ticks")), arguments.rate_hz,
                  short_bytes(number("held_bytes")), short_bytes(number("budget_bytes")));
  if (arguments.is_deterministic)
    text += fmt::format("simulated: a page takes {} us to read; seed {}\n",
                        static_cast<double>(arguments.latency_ns) / 1e3, arguments.seed);
  else
    text += fmt::format("late {}, ", grouped_count(number("late")));
  text += fmt::format("degraded {} ({:.3f} %), exact again after {} ticks (p99)\n",
                      grouped_count(number("degraded")),
                      100.0 * static_cast<double>(number("degraded")) /
                          static_cast<double>(std::max<std::uint64_t>(1, number("ticks"))),
                      number("refine_ticks_p99"));
  if (arguments.radius > 0)
    text += fmt::format("the surface stopped the ball of radius {} in {} ticks\n", arguments.radius,
                        grouped_count(number("touching")));
  if (!arguments.is_deterministic) text += machine_words(outcome.record, report);
  text += fmt::format("{} pages read, {} evicted\n", grouped_count(number("pages_read")),
                      grouped_count(number("pages_evicted")));
  if (const auto& prefetch = outcome.prefetch)
    text += fmt::format(
        "{} pages prefetched, of which {} used; {:.1f} % of the pages needed were there in time\n",
        grouped_count(prefetch->read), grouped_count(prefetch->used), 100 * prefetch->coverage());
  if (arguments.is_scene) text += instances_words(arguments, outcome);
  if (!arguments.trace.empty())
    text += fmt::format("{} records dropped from the trace\n", number("page_trace_dropped"));
  return text;
}

}  // namespace planetree::tools
