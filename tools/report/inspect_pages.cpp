#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "tools/cli/size_text.h"
#include "tools/html/figure_row.h"
#include "tools/html/html_table.h"
#include "tools/html/html_text.h"
#include "tools/report/inspect_plots.h"
#include "tools/report/inspect_sections.h"

namespace planetree::tools {
namespace {

/// Kinds of pages that the file has.
std::vector<std::size_t> kinds_in(const PageTally& tally) {
  std::vector<std::size_t> kinds;
  for (std::size_t kind = 0; kind < kPageKindCount; ++kind)
    if (std::ranges::any_of(tally.sizes(), [kind](const auto& bin) { return bin[kind] > 0; }))
      kinds.push_back(kind);
  return kinds;
}

std::string kind_words(std::size_t kind) {
  return std::string(page_kind_name(static_cast<PageKind>(kind)));
}

std::string page_sizes_cell(const InspectRecord& record, HtmlPage& page) {
  const PageTally& tally = record.pages;
  const double bin_kib =
      record.summary["page_bytes"].get<double>() / 1024 / static_cast<double>(PageTally::kSizes);
  const std::vector<std::size_t> kinds = kinds_in(tally);
  HtmlTable table{"Figures of the plot.", {{"", "from, KiB"}, {"", "to, KiB"}, {"", "pages"}}, {}};
  for (const std::size_t kind : kinds) table.columns.push_back({"kinds", kind_words(kind)});
  for (std::size_t i = 0; i < PageTally::kSizes; ++i) {
    const auto& bin = tally.sizes()[i];
    const std::uint64_t sum = std::accumulate(bin.begin(), bin.end(), std::uint64_t{0});
    if (sum == 0) continue;
    const std::string from = number_text(bin_kib * static_cast<double>(i));
    const std::string to = i + 1 < PageTally::kSizes
                               ? number_text(bin_kib * static_cast<double>(i + 1))
                               : std::string("more");
    std::vector<std::string> cells = {from, to, grouped_count(sum)};
    for (const std::size_t kind : kinds) cells.push_back(grouped_count(bin[kind]));
    add_figure_row(table, page, size_key_of(i), fmt::format("{} to {} KiB", from, to),
                   std::move(cells));
  }
  return plot_cell_html(column_plot_html(page_sizes_plot(record)) + table_html(table));
}

std::string compression_cell(const InspectRecord& record, HtmlPage& page) {
  const PageTally& tally = record.pages;
  HtmlTable table{"Figures of the plot.",
                  {{"", "pages", HtmlColumn::Kind::kText},
                   {"", "kinds", HtmlColumn::Kind::kText},
                   {"", "stored"},
                   {"", "before compression"},
                   {"", "stored share"}},
                  {}};
  if (tally.unreadable() > 0) table.columns.push_back({"", "unreadable"});
  for (std::size_t i = 0; i < tally.windows().size(); ++i) {
    const PageTally::Window& window = tally.windows()[i];
    std::string kinds;
    for (std::size_t kind = 0; kind < kPageKindCount; ++kind)
      if (window.pages[kind] > 0) kinds += (kinds.empty() ? "" : ", ") + kind_words(kind);
    const std::string numbers = window.first == window.last
                                    ? fmt::format("{}", window.first)
                                    : fmt::format("{} to {}", window.first, window.last);
    std::vector<std::string> cells = {
        numbers, kinds, short_bytes(window.stored_bytes), short_bytes(window.raw_bytes),
        fmt::format("{:.1f} %",
                    100 * static_cast<double>(window.stored_bytes) /
                        static_cast<double>(std::max<std::uint64_t>(window.raw_bytes, 1)))};
    if (tally.unreadable() > 0) cells.push_back(grouped_count(window.unreadable));
    add_figure_row(table, page, page_window_key(i),
                   (window.first == window.last ? "page " : "pages ") + numbers, std::move(cells));
  }
  return plot_cell_html(column_plot_html(compression_plot(record)) + table_html(table));
}

}  // namespace

std::string pages_section(const InspectRecord& record, HtmlPage& page) {
  const PageTally& tally = record.pages;
  if (tally.windows().empty())
    return section_html("Pages", paragraph_html("The directory of pages cannot be read."));
  std::string html;
  if (tally.unreadable() > 0)
    html = paragraph_html(fmt::format("{} {} cannot be read.", grouped_count(tally.unreadable()),
                                      tally.unreadable() == 1 ? "page" : "pages"));
  return section_html("Pages", html + row_of_plots_html(page_sizes_cell(record, page) +
                                                        compression_cell(record, page)));
}

}  // namespace planetree::tools
