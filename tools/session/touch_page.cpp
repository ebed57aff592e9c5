#include "tools/session/touch_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "tools/cli/policy_option.h"
#include "tools/cli/size_text.h"
#include "tools/html/figure_row.h"
#include "tools/html/html_table.h"
#include "tools/html/html_text.h"
#include "tools/session/prefetch_html.h"
#include "tools/session/session_report.h"
#include "tools/session/touch_instances.h"
#include "tools/session/touch_plots.h"

namespace planetree::tools {
namespace {

using TouchJson = nlohmann::ordered_json;

std::uint64_t number_in(const TouchJson& report, const char* key) {
  return report[key].get<std::uint64_t>();
}

std::string share_of_ticks(const TouchJson& report, const char* key) {
  const std::uint64_t ticks = std::max<std::uint64_t>(number_in(report, "ticks"), 1);
  return fmt::format(
      "{} ({} %)", grouped_count(number_in(report, key)),
      number_text(100 * static_cast<double>(number_in(report, key)) / static_cast<double>(ticks)));
}

HtmlFigures session_facts(const TouchArguments& arguments, const TouchJson& report) {
  HtmlFigures facts{"session", {}};
  const auto add = [&facts](const char* name, std::string value) {
    facts.values.emplace_back(name, std::move(value));
  };
  add("ticks",
      fmt::format("{} at {} Hz", grouped_count(number_in(report, "ticks")), arguments.rate_hz));
  add("path", name_of(arguments.motion));
  add("tool", arguments.radius > 0 ? fmt::format("ball of radius {}", number_text(arguments.radius))
                                   : "point");
  add("memory", fmt::format("{} of {}", short_bytes(number_in(report, "held_bytes")),
                            short_bytes(number_in(report, "budget_bytes"))));
  add("policy", name_of(arguments.policy));
  add("seed", std::to_string(arguments.seed));
  if (arguments.is_deterministic)
    add("simulated disk",
        fmt::format("{} us a page", number_text(static_cast<double>(arguments.latency_ns) / 1e3)));
  else
    add("late", share_of_ticks(report, "late"));
  add("degraded", share_of_ticks(report, "degraded"));
  if (arguments.radius > 0) add("touching", share_of_ticks(report, "touching"));
  return facts;
}

template <class Field>
std::vector<std::uint32_t> times_of(const TouchRecord& record, Field Tick::*field) {
  std::vector<std::uint32_t> values;
  for (const Tick& tick : record.ticks) values.push_back(tick.*field);
  return values;
}

std::string times_section(const TouchArguments& arguments, const TouchRecord& record,
                          HtmlPage& page) {
  const std::vector<TouchTimes> times = {
      {"latency", Sorted<std::uint32_t>(times_of(record, &Tick::latency_ns))},
      {"the query alone", Sorted<std::uint32_t>(times_of(record, &Tick::query_ns))},
      {"idle thread", Sorted<std::uint32_t>(record.floor_ns)}};
  HtmlTable table{
      "Figures of the plot, in microseconds.", {{"", "quantile", HtmlColumn::Kind::kText}}, {}};
  for (const TouchTimes& each : times) table.columns.push_back({"", each.name});
  const std::vector<double> shown = quantiles_shown(record.ticks.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::string name = i + 1 == shown.size() ? std::string("max") : quantile_words(shown[i]);
    std::vector<std::string> cells = {name};
    for (const TouchTimes& each : times)
      cells.push_back(number_text(each.nanoseconds.at(1 - 1 / shown[i]) / 1e3));
    add_figure_row(table, page, quantile_key(i), name + ", microseconds", std::move(cells));
  }
  return section_html(
      "Latency",
      paragraph_html(fmt::format(
          "From the time at which a tick is due to its answer. A tick that takes more than the {} "
          "us between ticks is late. The idle thread does nothing: its lateness is that of the "
          "machine.",
          number_text(1e6 / static_cast<double>(arguments.rate_hz)))) +
          row_of_plots_html(plot_html(times_plot(times, record.ticks.size()))) + table_html(table));
}

std::string width_cell(const TouchTimeline::Window& window) {
  if (window.degraded == 0) return "";
  return std::isfinite(window.max_width) ? number_text(window.max_width) : "no bound";
}

std::string time_section(const TouchArguments& arguments, const TouchTimeline& timeline,
                         HtmlPage& page) {
  const bool is_timed = !arguments.is_deterministic;
  const bool is_degraded = std::ranges::any_of(
      timeline.windows(), [](const TouchTimeline::Window& each) { return each.degraded > 0; });
  HtmlTable table{"Windows of time.",
                  {{"", "from, s"}, {"", "ticks"}, {"", "degraded"}, {"", "greatest width"}},
                  {}};
  if (arguments.radius > 0) table.columns.push_back({"", "touching"});
  if (is_timed) {
    table.columns.push_back({"", "late"});
    table.columns.push_back({"latency, us", "median"});
    table.columns.push_back({"latency, us", "max"});
  }
  for (std::size_t i = 0; i < timeline.windows().size(); ++i) {
    const TouchTimeline::Window& window = timeline.windows()[i];
    const std::string from = number_text(timeline.seconds(window.first));
    std::vector<std::string> cells = {from, grouped_count(window.ticks),
                                      grouped_count(window.degraded), width_cell(window)};
    if (arguments.radius > 0) cells.push_back(grouped_count(window.touching));
    if (is_timed) {
      cells.push_back(grouped_count(window.late));
      cells.push_back(number_text(window.median_latency_us));
      cells.push_back(number_text(window.max_latency_us));
    }
    add_figure_row(table, page, touch_window_key(i), fmt::format("from {} s", from),
                   std::move(cells));
  }
  std::string plots, note;
  if (is_timed) plots += column_plot_html(latency_plot(timeline));
  if (is_degraded)
    plots += column_plot_html(degraded_ticks_plot(timeline)) +
             column_plot_html(tick_width_plot(timeline));
  else
    note = paragraph_html("No tick is degraded.");
  if (!plots.empty()) plots = row_of_plots_html(plots);
  return section_html("Over time", note + plots + table_html(table));
}

/// A table of figures with what they are.
class FigureList {
 public:
  explicit FigureList(const char* caption)
      : table_{caption,
               {{"", "figure", HtmlColumn::Kind::kText},
                {"", "value"},
                {"", "what it is", HtmlColumn::Kind::kText}},
               {}} {}
  void add(const char* name, std::string value, const char* meaning) {
    table_.rows.push_back({"", false, "", {name, std::move(value), meaning}});
  }
  std::string html() const { return table_html(table_); }

 private:
  HtmlTable table_;
};

std::string answers_section(const TouchArguments& arguments, const TouchJson& report) {
  FigureList list("Answers of the ticks.");
  const std::uint64_t degraded = number_in(report, "degraded");
  list.add("exact", grouped_count(number_in(report, "ticks") - degraded), "all pages were there");
  list.add("degraded", grouped_count(degraded), "pages were missing, and the interval is wider");
  if (arguments.radius == 0)
    list.add("unknown sides", grouped_count(number_in(report, "unknown_sides")),
             "neither inside nor outside is proven");
  list.add("ticks to exact p50", grouped_count(number_in(report, "refine_ticks_p50")),
           "degraded ticks in a row, median");
  list.add("ticks to exact p99", grouped_count(number_in(report, "refine_ticks_p99")),
           "99 % quantile");
  list.add("ticks to exact max", grouped_count(number_in(report, "refine_ticks_max")), "greatest");
  for (const auto& [name, key, meaning] :
       {std::tuple{"degraded width p50", "degraded_width_p50", "model units, median"},
        std::tuple{"degraded width max", "degraded_width_max", "model units, greatest"}}) {
    const double width = report[key].get<double>();
    list.add(name, std::isfinite(width) ? number_text(width) : "no bound", meaning);
  }
  return section_html("Answers", list.html());
}

std::string memory_section(const TouchArguments& arguments, const TouchJson& report) {
  FigureList list("Memory and pages.");
  const auto count = [&](const char* key) { return grouped_count(number_in(report, key)); };
  list.add("budget", short_bytes(number_in(report, "budget_bytes")), "the memory that is allowed");
  list.add("held", short_bytes(number_in(report, "held_bytes")), "the memory that is used");
  list.add("frames", count("frames"), "pages that memory has room for");
  list.add("pages read", count("pages_read"), "from the disk");
  list.add("pages evicted", count("pages_evicted"), "to make room for others");
  list.add("pages prefetched", count("pages_prefetched"), "read for a motion");
  if (!arguments.is_scene)
    list.add("pages read ahead", count("pages_read_ahead"), "read while there was nothing to do");
  list.add("quarantined pages", count("quarantined_pages"), "damaged: the file is at fault");
  if (!arguments.trace.empty())
    list.add("records dropped", count("page_trace_dropped"), "from the trace");
  return section_html("Memory", list.html());
}

std::string machine_section(const TouchRecord& record, const TouchJson& report) {
  FigureList list("The querying thread and its machine.");
  const auto count = [&](const char* key) { return grouped_count(number_in(report, key)); };
  const auto granted = [](bool yes) { return std::string(yes ? "granted" : "refused"); };
  list.add("page faults", count("faults"), "during the ticks");
  list.add("voluntary switches", count("voluntary_switches"),
           "the thread waited for its next tick");
  list.add("involuntary switches", count("involuntary_switches"), "another thread took its place");
  list.add("real-time priority", granted(record.rights.fifo), "SCHED_FIFO");
  list.add("pinned", granted(record.rights.pinned), "to one processor");
  if (report.contains("locked_bytes"))
    list.add("locked", short_bytes(number_in(report, "locked_bytes")),
             "memory that is not swapped");
  list.add("peak resident", short_bytes(number_in(report, "peak_resident_bytes")),
           "memory of the whole process");
  return section_html("Machine", list.html());
}

}  // namespace

std::string touch_page(const TouchArguments& arguments, const TouchOutcome& outcome,
                       const std::string& command) {
  const TouchRecord& record = outcome.record;
  const TouchJson report = touch_report(arguments, outcome);
  const TouchTimeline timeline(record.ticks, 1'000'000'000 / arguments.rate_hz);
  HtmlPage page;
  page.kind = "planetree touch: a simulated haptic session";
  page.title = arguments.file.string();
  page.body = facts_html(session_facts(arguments, report));
  if (!arguments.is_deterministic) page.body += times_section(arguments, record, page);
  page.body += time_section(arguments, timeline, page) + answers_section(arguments, report) +
               memory_section(arguments, report);
  if (arguments.is_scene) page.body += instances_section(arguments, outcome);
  if (outcome.prefetch) page.body += prefetch_section(*outcome.prefetch);
  if (!arguments.is_deterministic) page.body += machine_section(record, report);
  page.body += section_html("Command", command_html("To make this page again", command));
  return page_html(page);
}

}  // namespace planetree::tools
