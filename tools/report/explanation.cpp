#include "tools/report/explanation.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "query/probe_state.h"
#include "query/serve/page_accessor.h"
#include "tools/answers/answer_words.h"
#include "tools/check/model_reader.h"
#include "tools/cli/coordinate_text.h"
#include "tools/cli/file_text.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;
using Rule = query::SideReason::Rule;

Json vector_json(const Vec3& v) { return {v.x, v.y, v.z}; }

std::string vector_text(const Vec3& v) {
  return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z);
}

std::string_view rule_word(Rule rule) {
  switch (rule) {
    case Rule::kNone:
      return "none";
    case Rule::kRegion:
      return "region";
    case Rule::kOutsideBox:
      return "outside_box";
    case Rule::kColour:
      return "colour";
    case Rule::kPlanes:
      return "planes";
    case Rule::kSlab:
      return "slab";
    case Rule::kCorner:
      return "corner";
    case Rule::kWayOut:
      return "exit_segment";
    case Rule::kWindingNumber:
      return "winding_number";
    case Rule::kFront:
      return "nearest_feature";
  }
  return "none";
}

std::string crossings_text(const Explanation& explanation) {
  const query::SideReason& reason = explanation.reason;
  return fmt::format(
      "from {}, where the winding number is {}, to the point the crossings change it by {}",
      vector_text(explanation.end), reason.known, reason.crossings);
}

std::string rule_text(const Explanation& explanation) {
  const std::string cell =
      fmt::format("cell {} of the mask", cell_text(explanation.reason.cell.octcode()));
  switch (explanation.reason.rule) {
    case Rule::kNone:
      return explanation.has_side_layer ? "pages that decide the side cannot be read"
                                        : "the file has no side layer";
    case Rule::kRegion:
      return "the file is of a region, and the point is beyond a wall";
    case Rule::kOutsideBox:
      return "the point is outside of the model's box";
    case Rule::kColour:
      return cell + (explanation.side_result.winding == 0  ? " is white"
                     : explanation.side_result.winding > 0 ? " is black"
                                                           : " is inverted");
    case Rule::kPlanes:
      return cell + " is special; the point's position relative to its planes decides";
    case Rule::kSlab:
      return cell + " is grey; the point is outside of the slab that holds the surface in the cell";
    case Rule::kCorner:
      return cell + " is grey; " + crossings_text(explanation);
    case Rule::kWayOut:
      return crossings_text(explanation);
    case Rule::kWindingNumber:
      return fmt::format(
          "the surface with its caps has the winding number {:g} there; less the caps' share it is "
          "{:.6g}, with an error of at most {:.2g}",
          explanation.reason.closed, explanation.reason.value, explanation.reason.error);
    case Rule::kFront:
      return fmt::format(
          "the file says that the surface is a sheet; the pseudo-normal of the nearest {} decides",
          feature_word(explanation.answer.feature));
  }
  return {};
}

std::string reason_text(const Explanation& explanation) {
  return rule_text(explanation) +
         (explanation.reason.caps_cannot_matter ? "; the caps are too far away to matter" : "");
}

Json work_json(const octree::TraversalStats& work) {
  return {{"nodes", work.nodes},
          {"blocks", work.blocks},
          {"triangles", work.triangles},
          {"page_switches", work.page_switches}};
}

std::string work_text(const octree::TraversalStats& work) {
  return fmt::format("{} nodes, {} blocks, {} triangles evaluated, {} page switches", work.nodes,
                     work.blocks, work.triangles, work.page_switches);
}

}  // namespace

std::optional<Vec3> parse_point(std::string_view text) {
  double values[3];
  if (!parse_coordinates(text, values)) return std::nullopt;
  return Vec3{values[0], values[1], values[2]};
}

Result<Explanation> explain(const std::filesystem::path& path, const Vec3& query) {
  auto opened = ModelReader::open(path);
  if (!opened) return opened.error();
  const query::ModelGeometry& model = opened->model->geometry();
  const auto probe = query::ProbeState::create(opened->model->serving(), std::move(opened->reader));
  const query::Scale& scale = model.scale;
  const octree::Point point = scale.in(query);
  Explanation result;
  result.query = query;
  result.answer = probe->closest_point(query, {});
  query::PageAccessor accessor(probe->reader(), Wait::kForPages);
  constexpr std::uint64_t kAllNodes = ~std::uint64_t{0};
  const query::SideMeans means = model.side_means(SideRule::kOfFile);
  result.has_side_layer = means != query::SideMeans::kNothing;
  if (means == query::SideMeans::kWindingNumber)
    result.side_result = query::find_side(model, point, kAllNodes, accessor.pages(),
                                          result.side_work, &result.reason);
  else if (means == query::SideMeans::kFront)
    result.reason.rule = Rule::kFront;
  result.pages_lost = opened->model->stats().quarantined_pages > 0;
  const octree::CellGrid grid(model.mask.lower);
  result.cell_lower = scale.out(grid.lower(result.reason.cell));
  result.cell_upper = scale.out(grid.upper(result.reason.cell));
  result.end = scale.out(result.reason.end);
  if (point.cwiseAbs().maxCoeff() > octree::kMaxQueryCoordinate) return result;
  const octree::NearestAnswer nearest =
      octree::nearest(model.tree, point, {}, accessor.pages(), result.nearest_work);
  for (int i = 0; i < 3; ++i) result.corners[i] = scale.out(nearest.corners[i]);
  return result;
}

Json explanation_json(const Explanation& explanation) {
  const ClosestPoint& answer = explanation.answer;
  const query::SideReason& reason = explanation.reason;
  Json json = {{"point", vector_json(explanation.query)},
               {"side", side_word(answer.side)},
               {"rule", rule_word(reason.rule)},
               {"because", reason_text(explanation)},
               {"winding", explanation.side_result.winding}};
  if (reason.in_mask)
    json["cell"] = {{"name", cell_text(reason.cell.octcode())},
                    {"lower", vector_json(explanation.cell_lower)},
                    {"upper", vector_json(explanation.cell_upper)}};
  if (reason.rule == Rule::kCorner || reason.rule == Rule::kWayOut)
    json["crossings"] = {{"from", vector_json(explanation.end)},
                         {"winding_there", reason.known},
                         {"change", reason.crossings}};
  if (reason.rule == Rule::kWindingNumber)
    json["winding_number"] = {
        {"with_caps", reason.closed}, {"value", reason.value}, {"error", reason.error}};
  json["distance"] = answer.distance;
  json["lower"] = answer.lower;
  json["upper"] = answer.upper;
  json["status"] = status_word(answer.status);
  json["nearest"] = {{"point", vector_json(answer.point)},
                     {"triangle", answer.triangle},
                     {"corners",
                      {vector_json(explanation.corners[0]), vector_json(explanation.corners[1]),
                       vector_json(explanation.corners[2])}},
                     {"feature", feature_word(answer.feature)},
                     {"normal", vector_json(answer.normal)}};
  json["work"] = {{"side", work_json(explanation.side_work)},
                  {"distance", work_json(explanation.nearest_work)}};
  return json;
}

std::string explanation_text(const Explanation& explanation) {
  const ClosestPoint& answer = explanation.answer;
  std::string text = fmt::format("point       {}\n", vector_text(explanation.query));
  text += fmt::format("side        {}: {}\n", side_word(answer.side), reason_text(explanation));
  if (explanation.reason.in_mask)
    text += fmt::format("cell        {} to {}\n", vector_text(explanation.cell_lower),
                        vector_text(explanation.cell_upper));
  text += fmt::format("distance    {:.17g}, certainly {:.17g} to {:.17g}; {}\n", answer.distance,
                      answer.lower, answer.upper, status_word(answer.status));
  text += fmt::format("nearest     {} on the {} of triangle {}: {} {} {}\n",
                      vector_text(answer.point), feature_word(answer.feature), answer.triangle,
                      vector_text(explanation.corners[0]), vector_text(explanation.corners[1]),
                      vector_text(explanation.corners[2]));
  text += fmt::format("normal      {}\n", vector_text(answer.normal));
  text += fmt::format("work        side: {}\n", work_text(explanation.side_work));
  text += fmt::format("            nearest point: {}\n", work_text(explanation.nearest_work));
  return text;
}

}  // namespace planetree::tools
