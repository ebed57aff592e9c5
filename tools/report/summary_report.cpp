#include "tools/report/summary_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "query/answer/model_geometry.h"
#include "storage/file/extension.h"
#include "tools/cli/attribute_option.h"
#include "tools/cli/file_text.h"
#include "tools/cli/size_text.h"
#include "tools/report/layer_report.h"
#include "tools/report/level_report.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

MaskLevelRow mask_sum(const FileSurvey& survey) {
  MaskLevelRow sum;
  for (const MaskLevelRow& row : survey.mask) {
    sum.white += row.white;
    sum.black += row.black;
    sum.grey += row.grey;
    sum.corners += row.corners;
    sum.special += row.special;
  }
  return sum;
}

std::string field_text(const storage::ModelRecord& model) {
  if (model.field_page_count == 0) return {};
  const std::uint32_t(&size)[3] = model.field_size;
  return fmt::format(
      "  field       {} x {} x {} grid points, {:.3g} apart, with the nearest surface points to "
      "{:.2g}\n",
      size[0], size[1], size[2], std::ldexp(model.field_step, -model.scale_exponent),
      std::ldexp(model.field_quantum, -model.scale_exponent));
}

Json field_json(const storage::ModelRecord& model) {
  if (model.field_page_count == 0) return nullptr;
  return {{"size", model.field_size},
          {"step", std::ldexp(model.field_step, -model.scale_exponent)},
          {"quantum", std::ldexp(model.field_quantum, -model.scale_exponent)},
          {"pages", model.field_page_count}};
}

std::string mask_text(const FileSurvey& survey, const Sections& sections, std::uint64_t triangles) {
  if (survey.mask.empty()) return {};
  const MaskLevelRow sum = mask_sum(survey);
  return fmt::format(
      "  mask        {} levels, {} white, {} black, {} grey cells, of those {} with corners, {} of "
      "them listing blocks, and {} special; {:.2f} bytes a triangle\n",
      survey.mask.size() - 1, grouped_count(sum.white), grouped_count(sum.black),
      grouped_count(sum.grey), grouped_count(sum.corners), grouped_count(survey.lists),
      grouped_count(sum.special), share(sections.mask_pages, triangles));
}

std::array<const std::vector<StreamRow>*, 5> streams_of(const FileSurvey& survey) {
  return {&survey.streams, &survey.cap_streams, &survey.field_streams, &survey.attribute_streams,
          &survey.mask_streams};
}

std::array<std::uint64_t, kStreamGroupCount> bytes_by_group(const FileSurvey& survey) {
  std::array<std::uint64_t, kStreamGroupCount> bytes{};
  for (const auto* rows : streams_of(survey))
    for (const StreamRow& row : *rows) bytes[static_cast<std::size_t>(row.group)] += row.bytes;
  return bytes;
}

Json bytes_json(const FileParts& parts, const FileSurvey& survey) {
  const Sections sections = sections_of(parts);
  Json raw = Json::object();
  const auto groups = bytes_by_group(survey);
  for (std::size_t i = 0; i < kStreamGroupCount; ++i)
    raw[std::string(group_name(static_cast<StreamGroup>(i)))] = groups[i];
  Json streams = Json::object();
  for (const auto* rows : streams_of(survey))
    for (const StreamRow& row : *rows) {
      // Streams of distance pages and of cap pages have the same names.
      const std::string name(row.name);
      streams[name] = streams.value(name, std::uint64_t{0}) + row.bytes;
    }
  return {{"headers", sections.headers},
          {"directory", sections.directory},
          {"distance_pages", sections.distance_pages},
          {"cap_pages", sections.cap_pages},
          {"field_pages", sections.field_pages},
          {"attribute_pages", sections.attribute_pages},
          {"mask_pages", sections.mask_pages},
          {"extensions", sections.extensions},
          {"within_pages", raw},
          {"within_pages_by_stream", streams}};
}

std::string point_text(const double (&values)[3]) {
  return fmt::format("{:.9g} {:.9g} {:.9g}", values[0], values[1], values[2]);
}

// The rule for sides, in one word.
std::string_view sign_rule(const storage::ModelRecord& model) {
  if (model.side_rule == storage::SideRule::kSurface) return "surface";
  if (!model.has_side_layer()) return "none";
  return model.unbalanced_edge_count == 0 ? "crossings" : "winding";
}

Json region_json(const storage::ModelRecord& model) {
  if (!model.has_region()) return nullptr;
  return {{"lower", model.region_lower},
          {"upper", model.region_upper},
          {"input_triangles", model.input_triangles}};
}

std::string region_text(const storage::ModelRecord& model) {
  if (!model.has_region()) return {};
  return fmt::format("  region      {} to {}: {} of the input's {} triangles touch it\n",
                     point_text(model.region_lower), point_text(model.region_upper),
                     grouped_count(model.triangle_count), grouped_count(model.input_triangles));
}

std::span<const storage::UnbalancedEdge> listed_unbalanced_edges(
    const storage::ModelRecord& model) {
  const std::uint64_t listed =
      std::min<std::uint64_t>(model.unbalanced_edge_count, std::size(model.unbalanced_edge));
  return std::span(model.unbalanced_edge).first(static_cast<std::size_t>(listed));
}

Json unbalanced_edges_json(const storage::ModelRecord& model) {
  Json edges = Json::array();
  for (const storage::UnbalancedEdge& edge : listed_unbalanced_edges(model))
    edges.push_back({{"triangle", edge.triangle},
                     {"from", edge.from},
                     {"to", edge.to},
                     {"along", edge.along},
                     {"against", edge.against}});
  return edges;
}

// The area of the caps in the input's units.
double cap_area(const storage::ModelRecord& model) {
  return std::ldexp(model.cap_area, -2 * model.scale_exponent);
}

std::string_view rule_text(const storage::ModelRecord& model) {
  if (model.side_rule == storage::SideRule::kSurface)
    return "sides by the nearest face, edge or vertex";
  if (!model.has_side_layer()) return "sides unknown without the side layer";
  return model.unbalanced_edge_count == 0 ? "sides by crossings, exactly"
                                          : "sides by winding number";
}

std::string surface_text(const storage::ModelRecord& model) {
  const std::string_view why = model.side_is_chosen != 0 ? ", as the build was told" : "";
  if (model.unbalanced_edge_count == 0)
    return fmt::format("  surface     watertight; {}{}\n", rule_text(model), why);
  std::string text = fmt::format(
      "  surface     not watertight; {}{}: {} unbalanced edges, openness {:.3g}{}\n",
      rule_text(model), why, grouped_count(model.unbalanced_edge_count), model.openness,
      model.cap_count == 0 ? ""
                           : fmt::format(", closed by {} caps of area {:.6g}",
                                         grouped_count(model.cap_count), cap_area(model)));
  for (const storage::UnbalancedEdge& edge : listed_unbalanced_edges(model))
    text += fmt::format("              {} to {} in triangle {}: {} faces that way, {} the other\n",
                        point_text(edge.from), point_text(edge.to), edge.triangle, edge.along,
                        edge.against);
  return text;
}

std::string raw_text(const FileSurvey& survey) {
  const auto groups = bytes_by_group(survey);
  std::uint64_t sum = 0;
  for (const std::uint64_t bytes : groups) sum += bytes;
  std::string text;
  for (std::size_t i = 0; i < kStreamGroupCount; ++i)
    text += fmt::format("{}{} {:.1f}%", i == 0 ? "" : ", ", group_name(static_cast<StreamGroup>(i)),
                        100 * share(groups[i], sum));
  return fmt::format("{} before compression: {}", short_bytes(sum), text);
}

// Metadata has a place of its own.
Json extensions_json(const FileParts& parts) {
  Json rows = Json::array();
  for (const storage::ExtensionRecord& record : parts.extensions()) {
    if (storage::name_of(record) == storage::kMetadataName) continue;
    rows.push_back({{"name", storage::name_of(record)},
                    {"bytes", record.bytes},
                    {"required", record.required != 0}});
  }
  return rows;
}

}  // namespace

Json summary_json(const FileParts& parts, const FileSurvey& survey) {
  if (parts.header() == nullptr) return {{"file_bytes", parts.actual_bytes()}};
  const storage::FileHeader& header = *parts.header();
  const storage::ModelRecord& model = header.model;
  Json json = {{"triangles", model.triangle_count},
               {"skipped", model.skipped_count},
               {"first_skipped", nullptr},
               {"vertices", model.vertex_count},
               {"box", {{"lower", model.box_lower}, {"upper", model.box_upper}}},
               {"core", {{"lower", model.core_lower}, {"upper", model.core_upper}}},
               {"strays", model.stray_count},
               {"region", region_json(model)},
               {"coordinates", parts.shape().float64 ? "float64" : "float32"},
               {"watertight", model.unbalanced_edge_count == 0},
               {"sign_rule", sign_rule(model)},
               {"sign_rule_is_chosen", model.side_is_chosen != 0},
               {"openness", model.openness},
               {"unbalanced_edges", model.unbalanced_edge_count},
               {"first_unbalanced_edges", unbalanced_edges_json(model)},
               {"caps",
                {{"count", model.cap_count},
                 {"area", cap_area(model)},
                 {"nodes", model.cap_node_count},
                 {"blocks", model.cap_block_count},
                 {"pages", model.cap_page_count}}},
               {"levels", model.height},
               {"nodes", model.node_count},
               {"blocks", model.block_count},
               {"height_field_blocks", survey.height_fields},
               {"pages", header.page_count},
               {"page_bytes", header.page_bytes},
               {"file_bytes", parts.actual_bytes()},
               {"bytes_per_triangle", share(header.file_bytes, model.triangle_count)},
               {"format_version", format_version_text(header.version)},
               {"content_id", content_id_text(header.content_id)},
               {"metadata", parts.metadata()},
               {"extensions", extensions_json(parts)},
               {"field", field_json(model)},
               {"attributes", attribute_words(model.attributes)},
               {"mask", mask_row_json(mask_sum(survey))},
               {"special_configurations", mask_sum(survey).special},
               {"lists_of_blocks", survey.lists},
               {"bytes", bytes_json(parts, survey)},
               {"min_budget_bytes", nullptr},
               {"layers", layers_json(parts)}};
  if (const auto bytes = min_budget_bytes(parts)) json["min_budget_bytes"] = *bytes;
  if (model.first_skipped != storage::kNoTriangle) json["first_skipped"] = model.first_skipped;
  return json;
}

std::string summary_text(const std::string& name, const FileParts& parts,
                         const FileSurvey& survey) {
  if (parts.header() == nullptr)
    return fmt::format("{}: {}\n", name, short_bytes(parts.actual_bytes()));
  const storage::FileHeader& header = *parts.header();
  const storage::ModelRecord& model = header.model;
  const Sections sections = sections_of(parts);
  std::string text = fmt::format(
      "{}: {} triangles, {} vertices of {}\n", name, grouped_count(model.triangle_count),
      grouped_count(model.vertex_count), parts.shape().float64 ? "float64" : "float32");
  if (model.skipped_count > 0)
    text += fmt::format("  skipped     {} triangles of bad records, the first is {}\n",
                        grouped_count(model.skipped_count), model.first_skipped);
  text += fmt::format("  box         {} to {}\n", point_text(model.box_lower),
                      point_text(model.box_upper));
  if (model.stray_count > 0)
    text += fmt::format("  core        {} to {}; {} stray triangles are far outside\n",
                        point_text(model.core_lower), point_text(model.core_upper),
                        grouped_count(model.stray_count));
  text += region_text(model);
  text += surface_text(model);
  text += fmt::format(
      "  tree        {} levels, {} nodes, {} blocks, {} of them height fields, {:.1f} "
      "triangles a block\n",
      model.height, grouped_count(model.node_count), grouped_count(model.block_count),
      grouped_count(survey.height_fields), share(model.triangle_count, model.block_count));
  text += field_text(model);
  if (model.attributes != 0)
    text += fmt::format("  attributes  {}\n", fmt::join(attribute_words(model.attributes), ", "));
  text += mask_text(survey, sections, model.triangle_count);
  text += fmt::format(
      "  file        {}, {:.2f} bytes a triangle: headers {}, directory {}, distance pages {}, {}"
      "field pages {}, {}mask pages {}\n",
      short_bytes(parts.actual_bytes()), share(header.file_bytes, model.triangle_count),
      short_bytes(sections.headers), short_bytes(sections.directory),
      short_bytes(sections.distance_pages),
      model.cap_count > 0 ? fmt::format("cap pages {}, ", short_bytes(sections.cap_pages)) : "",
      short_bytes(sections.field_pages),
      model.attributes != 0
          ? fmt::format("attribute pages {}, ", short_bytes(sections.attribute_pages))
          : "",
      short_bytes(sections.mask_pages));
  text += layers_line(parts);
  text += fmt::format("  pages       {}, {} each in memory; {}\n", grouped_count(header.page_count),
                      short_bytes(header.page_bytes), raw_text(survey));
  text += fmt::format("  content id  {}\n", content_id_text(header.content_id));
  for (const auto& [key, value] : parts.metadata())
    text += fmt::format("  {:<10}  {}\n", key, value);
  return text;
}

}  // namespace planetree::tools
