#include "tools/tune/tune_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/cli/policy_option.h"
#include "tools/cli/size_text.h"
#include "tools/html/html_page.h"
#include "tools/html/html_table.h"
#include "tools/html/html_text.h"
#include "tools/session/prefetch_html.h"
#include "tools/tune/tune_plots.h"
#include "tools/tune/tune_report.h"

namespace planetree::tools {
namespace {

std::string percent_text(double share) { return number_text(100 * share) + " %"; }

HtmlFigures facts(const TuneRecord& record) {
  return {"traces",
          {{"queries", grouped_count(record.queries)},
           {"page lookups", grouped_count(record.lookups)},
           {"seconds", number_text(record.seconds)},
           {"recorded with", fmt::format("{}, {}", short_bytes(record.recorded_memory_bytes),
                                         record.recorded_policy)},
           {"footprint", fmt::format("{} pages ({})", grouped_count(record.footprint),
                                     short_bytes(record.footprint * record.page_bytes))},
           {"compulsory misses", grouped_count(record.compulsory)},
           {"misses as recorded", grouped_count(record.recorded_misses)},
           {"degraded as recorded", grouped_count(record.degraded)}}};
}

std::string options_section(const TuneRecord& record) {
  const OptionsToSet options = options_to_set(record);
  std::string html;
  if (record.recommended && !record.recommended->is_kept)
    html += paragraph_html("The goal is not kept, even with all pages in memory.");
  return section_html("Options to set",
                      html + paragraph_html("For " + options.purpose + ".") +
                          command_html("OpenOptions, in a program", options.in_program) +
                          command_html("On the command line", options.on_command_line));
}

std::string curves_section(const TuneRecord& record) {
  const MissCurves& curves = record.curves;
  HtmlTable table{"Misses, in % of the lookups.", {{"", "frames"}, {"", "memory"}}, {}};
  for (const MissCurve& curve : curves.policies)
    table.columns.push_back({"policy", name_of(curve.policy)});
  table.columns.push_back({"bound", "stack LRU"});
  table.columns.push_back({"bound", "optimum"});
  for (std::size_t i = 0; i < curves.frames.size(); ++i) {
    HtmlRow row;
    row.key = size_key(i);
    row.cells = {grouped_count(curves.frames[i]), short_bytes(record.memory_for(curves.frames[i]))};
    const auto add = [&](double misses) {
      row.cells.push_back(number_text(100 * record.ratio(misses)));
    };
    for (const MissCurve& curve : curves.policies) add(curve.misses[i]);
    add(curves.stack[i]);
    add(curves.optimum[i]);
    table.rows.push_back(std::move(row));
  }
  std::string html = paragraph_html(
      "Misses of blocking queries without prefetch, if the cache is empty at the start. No policy "
      "is below the optimum.");
  if (curves.sampled_step > 1)
    html += paragraph_html(fmt::format(
        "From {} frames on, one in {} pages was replayed; misses are within {} % of "
        "the lookups of the exact ones.",
        curves.frames[curves.first_sampled], curves.sampled_step, number_text(100 * curves.error)));
  return section_html("Misses",
                      html + row_of_plots_html(plot_html(curves_plot(record))) + table_html(table));
}

std::vector<std::pair<std::string, std::string>> felt_figures(const FeltPoint& point) {
  const FeltFigures& figures = point.figures;
  return {{"memory", short_bytes(point.memory_bytes)},
          {"frames", grouped_count(point.frames)},
          {"degraded answers",
           percent_text(static_cast<double>(figures.degraded) /
                        static_cast<double>(std::max<std::size_t>(figures.ticks, 1)))},
          {"width p99", number_text(figures.width_p99)},
          {"ticks to exact p99", grouped_count(figures.ticks_to_exact_p99)},
          {"longest run", grouped_count(figures.longest_run)}};
}

std::string felt_section(const TuneRecord& record) {
  if (record.felt.empty())
    return section_html("What is felt",
                        paragraph_html("Not measured: the model of the traces was not replayed."));
  HtmlTable table{"Figures of the plots.", {}, {}};
  for (const auto& [name, text] : felt_figures(record.felt.front()))
    table.columns.push_back({"", name});
  for (std::size_t i = 0; i < record.felt.size(); ++i) {
    HtmlRow row;
    row.key = felt_key(i);
    for (auto& [name, text] : felt_figures(record.felt[i])) row.cells.push_back(std::move(text));
    table.rows.push_back(std::move(row));
  }
  const std::string plots = plot_html(degraded_felt_plot(record)) +
                            plot_html(width_felt_plot(record)) + plot_html(ticks_felt_plot(record));
  return section_html(
      "What is felt",
      paragraph_html(fmt::format(
          "The recorded motion, replayed within each budget. Queries do not wait; a page arrives "
          "{} us after its read begins.",
          number_text(static_cast<double>(record.latency_ns) / 1e3))) +
          row_of_plots_html(plots) + table_html(table));
}

std::string page_sizes_section(const TuneRecord& record) {
  if (record.page_sizes.empty()) return "";
  HtmlTable table{"Misses of CLOCK, estimated, within the memory of the frames.",
                  {{"", "page size"}, {"", "footprint"}},
                  {}};
  for (const std::uint64_t bytes : record.page_size_budgets)
    table.columns.push_back({"memory of the frames", short_bytes(bytes)});
  for (const PageSizeRow& size : record.page_sizes) {
    HtmlRow row;
    row.cells = {short_bytes(size.page_bytes), short_bytes(size.footprint_bytes)};
    for (const std::uint64_t misses : size.misses) row.cells.push_back(grouped_count(misses));
    table.rows.push_back(std::move(row));
  }
  return section_html("Page sizes", table_html(table));
}

std::string time_section(const TuneRecord& record) {
  HtmlTable table{"Windows of the first trace.",
                  {{"", "from, s"},
                   {"", "pages looked up"},
                   {"", "lookups"},
                   {"", "misses"},
                   {"", "degraded answers"},
                   {"", "pages in memory"}},
                  {}};
  const auto& windows = record.timeline.windows();
  for (std::size_t i = 0; i < windows.size(); ++i) {
    HtmlRow row;
    row.key = window_key(i);
    row.cells = {number_text(1e-9 * static_cast<double>(i * record.timeline.window_ns())),
                 grouped_count(windows[i].looked_up.size()),
                 grouped_count(windows[i].lookups),
                 grouped_count(windows[i].misses),
                 grouped_count(windows[i].degraded),
                 grouped_count(windows[i].resident.size())};
    table.rows.push_back(std::move(row));
  }
  return section_html("Place and time", row_of_plots_html(strip_html(looked_up_strip(record)) +
                                                          strip_html(resident_strip(record)) +
                                                          plot_html(working_set_plot(record))) +
                                            table_html(table));
}

void add_figures(const TuneRecord& record, HtmlPage& page) {
  const MissCurves& curves = record.curves;
  for (std::size_t i = 0; i < curves.frames.size(); ++i) {
    HtmlFigures figures{fmt::format("{} frames, misses a lookup", grouped_count(curves.frames[i])),
                        {}};
    for (const MissCurve& curve : curves.policies)
      figures.values.emplace_back(name_of(curve.policy),
                                  percent_text(record.ratio(curve.misses[i])));
    figures.values.emplace_back("optimum", percent_text(record.ratio(curves.optimum[i])));
    figures.values.emplace_back("memory", short_bytes(record.memory_for(curves.frames[i])));
    page.figures[size_key(i)] = std::move(figures);
  }
  for (std::size_t i = 0; i < record.felt.size(); ++i)
    page.figures[felt_key(i)] = {short_bytes(record.felt[i].memory_bytes),
                                 felt_figures(record.felt[i])};
  const auto& windows = record.timeline.windows();
  for (std::size_t i = 0; i < windows.size(); ++i)
    page.figures[window_key(i)] = {
        fmt::format("from {} s",
                    number_text(1e-9 * static_cast<double>(i * record.timeline.window_ns()))),
        {{"pages looked up", grouped_count(windows[i].looked_up.size())},
         {"misses", grouped_count(windows[i].misses)},
         {"degraded answers", grouped_count(windows[i].degraded)}}};
}

}  // namespace

std::string tune_page(const TuneRecord& record, const std::string& command) {
  HtmlPage page;
  page.kind = "planetree tune: what memory a recorded session needs";
  for (const std::string& trace : record.traces)
    page.title += (page.title.empty() ? "" : ", ") + trace;
  page.body = facts_html(facts(record)) + options_section(record) + curves_section(record) +
              felt_section(record) + page_sizes_section(record) +
              prefetch_section(record.prefetch) + time_section(record) +
              section_html("Command", command_html("To make this page again", command));
  add_figures(record, page);
  return page_html(page);
}

}  // namespace planetree::tools
