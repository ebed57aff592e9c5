#include "tools/tune/tune_report.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "tools/cli/policy_option.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand.h"
#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

/// A budget that text can state: whole KiB, rounded up.
std::uint64_t whole_kib(std::uint64_t bytes) { return (bytes + 1023) / 1024; }

const char* enumerator_of(EvictionPolicy policy) {
  switch (policy) {
    case EvictionPolicy::kClock:
      return "kClock";
    case EvictionPolicy::kLru:
      return "kLru";
    case EvictionPolicy::kSieve:
      return "kSieve";
    case EvictionPolicy::kS3Fifo:
      return "kS3Fifo";
    case EvictionPolicy::kTwoQ:
      return "kTwoQ";
  }
  return "";
}

std::string head(const TuneRecord& record) {
  std::string text;
  for (const std::string& trace : record.traces) text += (text.empty() ? "" : ", ") + trace;
  text += fmt::format(": {} queries, {} page lookups in {:.1f} s, recorded with {} ({})\n",
                      grouped_count(record.queries), grouped_count(record.lookups), record.seconds,
                      short_bytes(record.recorded_memory_bytes), record.recorded_policy);
  if (record.lost > 0)
    text += fmt::format("{} records were dropped while recording: counts are too low\n",
                        grouped_count(record.lost));
  text += fmt::format(
      "footprint {} pages ({}) of {} ({}); {} compulsory misses; as recorded {} misses, {} "
      "evictions, {} degraded answers\n",
      grouped_count(record.footprint), short_bytes(record.footprint * record.page_bytes),
      grouped_count(record.model_pages), short_bytes(record.model_pages * record.page_bytes),
      grouped_count(record.compulsory), grouped_count(record.recorded_misses),
      grouped_count(record.evictions), grouped_count(record.degraded));
  return text;
}

std::string curves(const TuneRecord& record) {
  const MissCurves& curves = record.curves;
  std::string text = "\nmisses, in % of the lookups, of blocking queries without prefetch\n";
  text += fmt::format("{:>9}{:>12}", "frames", "memory");
  for (const MissCurve& curve : curves.policies)
    text += fmt::format("{:>9}", name_of(curve.policy));
  text += fmt::format("{:>11}{:>9}\n", "stack lru", "optimum");
  const auto percent = [&](double misses) { return 100 * record.ratio(misses); };
  for (std::size_t i = 0; i < curves.frames.size(); ++i) {
    text += fmt::format("{:>9}{:>12}", curves.frames[i],
                        short_bytes(record.memory_for(curves.frames[i])));
    for (const MissCurve& curve : curves.policies)
      text += fmt::format("{:>9.3f}", percent(curve.misses[i]));
    text += fmt::format("{:>11.3f}{:>9.3f}{}\n", percent(curves.stack[i]),
                        percent(curves.optimum[i]), i == record.knee ? "  knee of clock" : "");
  }
  if (curves.sampled_step > 1)
    text += fmt::format(
        "from {} frames on, one in {} pages was replayed: misses are within {} % of the lookups "
        "of the exact ones, as far as those of stack lru tell\n",
        curves.frames[curves.first_sampled], curves.sampled_step, number_text(100 * curves.error));
  return text;
}

std::string prefetch(const TuneRecord& record) {
  const PrefetchFigures& figures = record.prefetch;
  if (figures.read == 0) return "\nno page was read for a motion\n";
  return fmt::format(
      "\nprefetch, as recorded: {} pages read; {:.1f} % of them used (accuracy), {:.1f} % of the "
      "pages needed (coverage), {:.1f} % in time (timeliness), {:.1f} % evicted unused (waste)\n",
      grouped_count(figures.read), 100 * figures.accuracy(), 100 * figures.coverage(),
      100 * figures.timeliness(), 100 * figures.waste());
}

std::string felt(const TuneRecord& record) {
  if (record.felt.empty()) return "";
  std::string text = fmt::format(
      "\nfelt by the recorded motion, replayed: a page arrives after {} us\n"
      "{:>12}{:>9}{:>12}{:>12}{:>16}{:>13}\n",
      number_text(static_cast<double>(record.latency_ns) / 1e3), "memory", "frames", "degraded %",
      "width p99", "ticks to exact", "longest run");
  for (const FeltPoint& point : record.felt)
    text += fmt::format("{:>12}{:>9}{:>12.4f}{:>12}{:>16}{:>13}\n", short_bytes(point.memory_bytes),
                        point.frames,
                        100 * static_cast<double>(point.figures.degraded) /
                            static_cast<double>(std::max<std::size_t>(point.figures.ticks, 1)),
                        number_text(point.figures.width_p99), point.figures.ticks_to_exact_p99,
                        point.figures.longest_run);
  return text;
}

std::string page_sizes(const TuneRecord& record) {
  if (record.page_sizes.empty()) return "";
  std::string text = "\nmisses by page size and memory of the frames, policy clock\n";
  text += fmt::format("{:>12}{:>12}", "page size", "footprint");
  for (const std::uint64_t bytes : record.page_size_budgets)
    text += fmt::format("{:>12}", short_bytes(bytes));
  text += '\n';
  for (const PageSizeRow& row : record.page_sizes) {
    text +=
        fmt::format("{:>12}{:>12}", short_bytes(row.page_bytes), short_bytes(row.footprint_bytes));
    for (const std::uint64_t misses : row.misses) text += fmt::format("{:>12}", misses);
    text += '\n';
  }
  return text;
}

std::string goal_text(const TuneGoal& goal) {
  return fmt::format("{} < {}", name_of(goal.quantity), text_of(goal.quantity, goal.limit));
}

Json json_of(const std::vector<std::uint32_t>& frames, const std::vector<double>& misses) {
  Json points = Json::array();
  for (std::size_t i = 0; i < frames.size(); ++i)
    points.push_back({{"frames", frames[i]}, {"misses", misses[i]}});
  return points;
}

Json json_of(const FeltPoint& point) {
  const FeltFigures& figures = point.figures;
  return {{"memory_bytes", point.memory_bytes},
          {"frames", point.frames},
          {"ticks", figures.ticks},
          {"degraded", figures.degraded},
          {"width_p99", figures.width_p99},
          {"ticks_to_exact_p99", figures.ticks_to_exact_p99},
          {"longest_run", figures.longest_run}};
}

Json json_of(const std::optional<TuneRecommendation>& recommended) {
  if (!recommended) return {};
  Json json = {{"goal", name_of(recommended->goal.quantity)},
               {"limit", recommended->goal.limit},
               {"kept", recommended->is_kept}};
  if (!recommended->is_kept) return json;
  json["memory_bytes"] = recommended->memory_bytes;
  json["frames"] = recommended->frames;
  json["policy"] = name_of(recommended->policy);
  json["low"] = recommended->low_bytes;
  json["high"] = recommended->high_bytes;
  json["value"] = recommended->value;
  return json;
}

}  // namespace

OptionsToSet options_to_set(const TuneRecord& record) {
  OptionsToSet options;
  EvictionPolicy policy = EvictionPolicy::kClock;
  std::uint64_t kib = 0;
  const auto& recommended = record.recommended;
  if (recommended && recommended->is_kept) {
    policy = recommended->policy;
    kib = whole_kib(recommended->memory_bytes);
    options.purpose =
        fmt::format("{}, with {} ({} to {})", goal_text(recommended->goal),
                    short_bytes(recommended->memory_bytes), short_bytes(recommended->low_bytes),
                    short_bytes(recommended->high_bytes));
  } else if (!record.curves.frames.empty()) {
    const std::uint32_t frames = record.curves.frames[record.knee];
    options.purpose = fmt::format("the knee of clock's curve, {} frames: more save little", frames);
    if (record.model.empty()) {
      options.in_program = options.on_command_line = "name the model by --model to get the budget";
      return options;
    }
    kib = whole_kib(record.memory_for(frames));
  }
  options.in_program =
      fmt::format("{{.memory_budget_bytes = {}, .max_probes = 1, .policy = EvictionPolicy::{}}}",
                  kib * 1024, enumerator_of(policy));
  options.on_command_line = fmt::format("--memory {}K --policy {}", kib, name_of(policy));
  return options;
}

std::string tune_words(const TuneRecord& record) {
  std::string text =
      head(record) + curves(record) + prefetch(record) + felt(record) + page_sizes(record);
  if (record.recommended && !record.recommended->is_kept)
    text += fmt::format("\n{} is not kept, even with all pages in memory\n",
                        goal_text(record.recommended->goal));
  const OptionsToSet options = options_to_set(record);
  return text + fmt::format("\nFor {}\n  OpenOptions  {}\n  touch        {}\n", options.purpose,
                            options.in_program, options.on_command_line);
}

std::string tune_json(const TuneRecord& record) {
  Json curves = Json::array(), felt = Json::array(), sizes = Json::array();
  for (const MissCurve& curve : record.curves.policies)
    curves.push_back({{"policy", name_of(curve.policy)},
                      {"points", json_of(record.curves.frames, curve.misses)}});
  for (const FeltPoint& point : record.felt) felt.push_back(json_of(point));
  for (const PageSizeRow& row : record.page_sizes)
    sizes.push_back({{"page_bytes", row.page_bytes},
                     {"footprint_pages", row.footprint},
                     {"misses", row.misses}});
  const PrefetchFigures& prefetch = record.prefetch;
  return json_line(
      {{"traces", record.traces},
       {"references", record.lookups},
       {"queries", record.queries},
       {"seconds", record.seconds},
       {"lost_records", record.lost},
       {"footprint_pages", record.footprint},
       {"compulsory_misses", record.compulsory},
       {"page_bytes", record.page_bytes},
       {"recorded_misses", record.recorded_misses},
       {"curves", curves},
       {"stack_lru", json_of(record.curves.frames, record.curves.stack)},
       {"optimum", json_of(record.curves.frames, record.curves.optimum)},
       {"sampled_step", record.curves.sampled_step},
       {"sampling_error", record.curves.error},
       {"knee_frames", record.curves.frames.empty() ? 0 : record.curves.frames[record.knee]},
       {"prefetch",
        {{"read", prefetch.read},
         {"accuracy", prefetch.accuracy()},
         {"coverage", prefetch.coverage()},
         {"timeliness", prefetch.timeliness()},
         {"waste", prefetch.waste()}}},
       {"latency_ns", record.latency_ns},
       {"felt", felt},
       {"page_size_budgets", record.page_size_budgets},
       {"page_sizes", sizes},
       {"recommended", json_of(record.recommended)}});
}

}  // namespace planetree::tools
