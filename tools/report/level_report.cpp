#include "tools/report/level_report.h"

#include <fmt/format.h>

#include <cstddef>

#include "tools/cli/size_text.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string mask_levels_text(const FileSurvey& survey) {
  std::string text = fmt::format("{:>5} {:>13} {:>13} {:>15} {:>13} {:>15}\n", "mask", "white",
                                 "black", "grey", "with corners", "special");
  for (std::size_t level = 0; level < survey.mask.size(); ++level) {
    const MaskLevelRow& row = survey.mask[level];
    text += fmt::format("{:>5} {:>13} {:>13} {:>15} {:>13} {:>15}\n", level,
                        grouped_count(row.white), grouped_count(row.black), grouped_count(row.grey),
                        grouped_count(row.corners), grouped_count(row.special));
  }
  return text;
}

}  // namespace

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

Json mask_row_json(const MaskLevelRow& row) {
  return {{"white", row.white},
          {"black", row.black},
          {"grey", row.grey},
          {"with_corners", row.corners},
          {"special", row.special}};
}

Json mask_levels_json(const FileSurvey& survey) {
  Json rows = Json::array();
  for (std::size_t level = 0; level < survey.mask.size(); ++level) {
    rows.push_back({{"level", level}});
    rows.back().update(mask_row_json(survey.mask[level]));
  }
  return rows;
}

Json levels_json(const FileSurvey& survey) {
  Json rows = Json::array();
  for (std::size_t depth = 0; depth < survey.levels.size(); ++depth) {
    const LevelRow& row = survey.levels[depth];
    rows.push_back({{"depth", depth},
                    {"nodes", row.nodes},
                    {"blocks", row.blocks},
                    {"triangles", row.triangles},
                    {"children_per_node", share(row.children, row.nodes)},
                    {"triangles_per_block", share(row.triangles, row.blocks)},
                    {"pages", row.pages},
                    {"page_bytes", row.page_bytes}});
  }
  return rows;
}

std::string levels_text(const FileSurvey& survey) {
  std::string text = fmt::format("{:>5} {:>13} {:>13} {:>15} {:>13} {:>15}\n", "depth", "nodes",
                                 "blocks", "triangles", "children/node", "triangles/block");
  for (std::size_t depth = 0; depth < survey.levels.size(); ++depth) {
    const LevelRow& row = survey.levels[depth];
    text += fmt::format("{:>5} {:>13} {:>13} {:>15} {:>13.2f} {:>15.2f}\n", depth,
                        grouped_count(row.nodes), grouped_count(row.blocks),
                        grouped_count(row.triangles), share(row.children, row.nodes),
                        share(row.triangles, row.blocks));
  }
  if (!survey.mask.empty()) text += mask_levels_text(survey);
  if (survey.unreached_pages > 0)
    text += fmt::format("{} pages below unreadable pages are not counted\n",
                        grouped_count(survey.unreached_pages));
  return text;
}

}  // namespace planetree::tools
