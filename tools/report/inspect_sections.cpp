#include "tools/report/inspect_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "tools/cli/size_text.h"
#include "tools/html/figure_row.h"
#include "tools/html/html_table.h"
#include "tools/html/html_text.h"
#include "tools/report/inspect_plots.h"

namespace planetree::tools {
namespace {

using SectionJson = nlohmann::ordered_json;

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}
std::string percent_words(double share) { return fmt::format("{:.1f} %", 100 * share); }

std::string bytes_cell(const std::string& id, const std::string& title, const std::string& what,
                       const std::vector<BytePart>& parts, std::uint64_t triangles,
                       HtmlPage& page) {
  std::uint64_t sum = 0;
  for (const BytePart& part : parts) sum += part.bytes;
  HtmlTable table{what,
                  {{"", "part", HtmlColumn::Kind::kText},
                   {"", "bytes"},
                   {"", "share"},
                   {"", "bytes a triangle"}},
                  {}};
  for (std::size_t i = 0; i < parts.size(); ++i)
    add_figure_row(
        table, page, part_key(id, i), parts[i].name,
        {parts[i].name, grouped_count(parts[i].bytes), percent_words(ratio(parts[i].bytes, sum)),
         fmt::format("{:.2f}", ratio(parts[i].bytes, triangles))});
  table.rows.push_back({"",
                        false,
                        {},
                        {"all", grouped_count(sum), percent_words(sum > 0 ? 1 : 0),
                         fmt::format("{:.2f}", ratio(sum, triangles))}});
  return plot_cell_html(
      bar_plot_html(bytes_plot(id, title, what + " The table below has the figures.", parts)) +
      table_html(table));
}

/// The parts of an object of counts, without those that are absent from the file.
std::vector<BytePart> parts_in(const SectionJson& object) {
  std::vector<BytePart> parts;
  for (const auto& [name, bytes] : object.items())
    if (bytes.is_number() && bytes != 0) {
      std::string words = name;
      std::ranges::replace(words, '_', ' ');
      parts.push_back({words, bytes.get<std::uint64_t>()});
    }
  return parts;
}

}  // namespace

std::string bytes_section(const InspectRecord& record, HtmlPage& page) {
  const SectionJson& bytes = record.summary["bytes"];
  const std::uint64_t triangles = record.summary["triangles"];
  std::string cells =
      bytes_cell("sections", "Bytes of the file by section",
                 "Stored bytes of the parts of the file.", parts_in(bytes), triangles, page);
  if (const auto within = parts_in(bytes["within_pages"]); !within.empty())
    cells += bytes_cell("streams", "Bytes within pages, before compression",
                        "Bytes of the streams within all pages, before compression.", within,
                        triangles, page);
  return section_html("Bytes", row_of_plots_html(cells));
}

std::string memory_section(const InspectRecord& record) {
  const SectionJson& summary = record.summary;
  const SectionJson& least = summary["min_budget_bytes"];
  const std::uint64_t frames =
      summary["pages"].get<std::uint64_t>() * summary["page_bytes"].get<std::uint64_t>();
  std::string html = paragraph_html(
      least.is_null()
          ? "The file cannot be opened, so that the least budget is not known."
          : fmt::format("The least memory budget, with one probe and all layers, is {}. Frames for "
                        "all pages take {}.",
                        short_bytes(least.get<std::uint64_t>()), short_bytes(frames)));
  HtmlTable table{
      "Layers of the file. Leaving one out at open saves of the least budget, and its frames.",
      {{"", "layer", HtmlColumn::Kind::kText},
       {"", "pages"},
       {"", "stored"},
       {"", "frames for all"},
       {"", "saves of the least budget"}},
      {}};
  for (const auto& [name, layer] : summary["layers"].items()) {
    HtmlRow row;
    row.is_muted = layer.is_null();
    row.muted_note = "not in the file";
    row.cells = {name, "", "", "", ""};
    if (!layer.is_null()) {
      row.cells[1] = grouped_count(layer["pages"].get<std::uint64_t>());
      row.cells[2] = short_bytes(layer["bytes"].get<std::uint64_t>());
      row.cells[3] = short_bytes(layer["frame_bytes"].get<std::uint64_t>());
      const SectionJson saved = layer.value("min_budget_saved_bytes", SectionJson());
      row.cells[4] = !saved.is_null()     ? short_bytes(saved.get<std::uint64_t>())
                     : name == "distance" ? "always open"
                                          : "unknown";
    }
    table.rows.push_back(std::move(row));
  }
  return section_html("Memory", html + table_html(table));
}

std::string tree_section(const InspectRecord& record, HtmlPage& page) {
  const FileSurvey& survey = record.survey;
  std::string html =
      paragraph_html(fmt::format("{} levels, {} nodes, {} blocks.", record.summary["levels"].dump(),
                                 grouped_count(record.summary["nodes"].get<std::uint64_t>()),
                                 grouped_count(record.summary["blocks"].get<std::uint64_t>())));
  if (survey.unreached_pages > 0)
    html += paragraph_html(fmt::format("{} pages below unreadable pages are not counted.",
                                       grouped_count(survey.unreached_pages)));
  if (survey.levels.size() > kMaxLevelsShown)
    html += paragraph_html(
        fmt::format("The first {} of {} depths are shown.", kMaxLevelsShown, survey.levels.size()));
  if (survey.levels.empty())
    return section_html("Tree", html + paragraph_html("No node can be read."));
  HtmlTable table{"Figures of both plots.",
                  {{"", "depth"},
                   {"", "nodes"},
                   {"", "blocks"},
                   {"", "triangles"},
                   {"", "children a node"},
                   {"", "triangles a block"},
                   {"begin here", "pages"},
                   {"begin here", "stored bytes"}},
                  {}};
  for (std::size_t depth = 0; depth < std::min(survey.levels.size(), kMaxLevelsShown); ++depth) {
    const LevelRow& row = survey.levels[depth];
    add_figure_row(
        table, page, depth_key(depth), fmt::format("depth {}", depth),
        {std::to_string(depth), grouped_count(row.nodes), grouped_count(row.blocks),
         grouped_count(row.triangles), fmt::format("{:.2f}", ratio(row.children, row.nodes)),
         fmt::format("{:.2f}", ratio(row.triangles, row.blocks)), grouped_count(row.pages),
         grouped_count(row.page_bytes)});
  }
  return section_html("Tree", html +
                                  row_of_plots_html(plot_html(depth_plot(survey)) +
                                                    column_plot_html(depth_bytes_plot(survey))) +
                                  table_html(table));
}

std::string mask_section(const InspectRecord& record, HtmlPage& page) {
  const FileSurvey& survey = record.survey;
  if (survey.mask.empty()) return {};
  HtmlTable table{"Figures of the plot. Black cells are inside.",
                  {{"", "level"},
                   {"cells", "white"},
                   {"cells", "black"},
                   {"cells", "grey"},
                   {"of the grey", "with corners"},
                   {"of the grey", "special"}},
                  {}};
  for (std::size_t level = 0; level < std::min(survey.mask.size(), kMaxLevelsShown); ++level) {
    const MaskLevelRow& row = survey.mask[level];
    add_figure_row(
        table, page, mask_level_key(level), fmt::format("level {}", level),
        {std::to_string(level), grouped_count(row.white), grouped_count(row.black),
         grouped_count(row.grey), grouped_count(row.corners), grouped_count(row.special)});
  }
  return section_html("Mask", row_of_plots_html(plot_html(mask_plot(survey))) + table_html(table));
}

}  // namespace planetree::tools
