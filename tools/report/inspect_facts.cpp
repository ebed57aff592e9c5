#include "tools/report/inspect_facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/cli/size_text.h"
#include "tools/html/html_table.h"
#include "tools/html/html_text.h"

namespace planetree::tools {
namespace {

using FactJson = nlohmann::ordered_json;

std::string count_text(const FactJson& count) { return grouped_count(count.get<std::uint64_t>()); }

std::string point_words(const FactJson& point) {
  std::string text;
  for (const FactJson& coordinate : point)
    text += fmt::format("{}{:.6g}", text.empty() ? "" : ", ", coordinate.get<double>());
  return text;
}

std::string box_words(const FactJson& box) {
  return point_words(box["lower"]) + " to " + point_words(box["upper"]);
}

std::string edges_table(const FactJson& edges) {
  HtmlTable table{"The first unbalanced edges, with the number of faces in either direction.",
                  {{"", "triangle"},
                   {"", "from", HtmlColumn::Kind::kText},
                   {"", "to", HtmlColumn::Kind::kText},
                   {"faces", "that way"},
                   {"faces", "the other"}},
                  {}};
  for (const FactJson& edge : edges) {
    HtmlRow row;
    row.cells = {edge["triangle"].dump(), point_words(edge["from"]), point_words(edge["to"]),
                 edge["along"].dump(), edge["against"].dump()};
    table.rows.push_back(std::move(row));
  }
  return table_html(table);
}

std::string place_of(std::uint64_t place) {
  return place == Error::kNowhere ? std::string() : grouped_count(place);
}

}  // namespace

HtmlFigures inspect_facts(const InspectRecord& record) {
  const FactJson& summary = record.summary;
  HtmlFigures facts{"file", {}};
  const auto add = [&facts](const char* name, std::string value) {
    facts.values.emplace_back(name, std::move(value));
  };
  const std::uint64_t file_bytes = summary["file_bytes"];
  if (!summary.contains("triangles")) {
    add("file", short_bytes(file_bytes));
    return facts;
  }
  add("triangles", count_text(summary["triangles"]));
  add("vertices", fmt::format("{} of {}", count_text(summary["vertices"]),
                              summary["coordinates"].get<std::string>()));
  if (summary["skipped"] != 0)
    add("skipped", fmt::format("{}, the first is {}", count_text(summary["skipped"]),
                               summary["first_skipped"].dump()));
  add("box", box_words(summary["box"]));
  if (summary["strays"] != 0)
    add("core", fmt::format("{}; {} stray triangles are far outside", box_words(summary["core"]),
                            count_text(summary["strays"])));
  if (!summary["region"].is_null())
    add("region", fmt::format("{}, of {} triangles", box_words(summary["region"]),
                              count_text(summary["region"]["input_triangles"])));
  add("watertight", summary["watertight"].get<bool>() ? "yes" : "no");
  add("blocks", fmt::format("{}, {} of them height fields", count_text(summary["blocks"]),
                            count_text(summary["height_field_blocks"])));
  add("pages", fmt::format("{} of {}", count_text(summary["pages"]),
                           short_bytes(summary["page_bytes"].get<std::uint64_t>())));
  add("file", fmt::format("{}, {:.2f} bytes a triangle", short_bytes(file_bytes),
                          summary["bytes_per_triangle"].get<double>()));
  if (!summary["field"].is_null())
    add("field", fmt::format("{} points, {:.3g} apart",
                             fmt::join(summary["field"]["size"].get<std::vector<int>>(), " x "),
                             summary["field"]["step"].get<double>()));
  if (!summary["attributes"].empty())
    add("attributes",
        fmt::format("{}", fmt::join(summary["attributes"].get<std::vector<std::string>>(), ", ")));
  add("format version", summary["format_version"].get<std::string>());
  add("content id", summary["content_id"].get<std::string>());
  return facts;
}

std::string surface_section(const InspectRecord& record) {
  const FactJson& summary = record.summary;
  const std::string rule = summary["sign_rule"];
  std::string text = summary["watertight"].get<bool>() ? "The surface is watertight. "
                                                       : "The surface is not watertight. ";
  if (rule == "crossings") text += "Sides are found by crossings, exactly";
  if (rule == "winding") text += "Sides are found by winding number";
  if (rule == "surface") text += "Sides are those of the nearest face, edge or vertex";
  if (rule == "none") text += "Sides are unknown without the side layer";
  text += summary["sign_rule_is_chosen"].get<bool>() ? ", as the build was told." : ".";
  const FactJson& edges = summary["first_unbalanced_edges"];
  if (edges.empty()) return section_html("Surface", paragraph_html(text));
  text += fmt::format(" {} edges are unbalanced; the openness is {:.3g}.",
                      count_text(summary["unbalanced_edges"]), summary["openness"].get<double>());
  if (summary["caps"]["count"] != 0)
    text += fmt::format(" {} caps of area {:.6g} close it.", count_text(summary["caps"]["count"]),
                        summary["caps"]["area"].get<double>());
  return section_html("Surface", paragraph_html(text) + edges_table(edges));
}

std::string issues_section(const InspectRecord& record) {
  constexpr std::size_t kMaxListed = 100;
  const IssueList& issues = record.survey.issues;
  if (issues.count() == 0) return {};
  const std::size_t listed = std::min(issues.kept().size(), kMaxListed);
  HtmlTable table{issues.count() > listed
                      ? fmt::format("The first {} of {} issues; planetree verify lists all.",
                                    listed, grouped_count(issues.count()))
                      : "What is damaged. planetree verify --full checks more.",
                  {{"", "issue", HtmlColumn::Kind::kText},
                   {"", "page"},
                   {"", "at byte"},
                   {"", "what", HtmlColumn::Kind::kText}},
                  {}};
  for (std::size_t i = 0; i < listed; ++i) {
    const Issue& issue = issues.kept()[i];
    HtmlRow row;
    row.cells = {std::string(issue_name(issue.code)), place_of(issue.page), place_of(issue.offset),
                 issue.message};
    table.rows.push_back(std::move(row));
  }
  return section_html("Issues",
                      paragraph_html("The file is damaged. The figures below are those of what "
                                     "can be read.") +
                          table_html(table));
}

}  // namespace planetree::tools
