#include "tools/report/layer_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "planetree/layers.h"
#include "planetree/model.h"
#include "query/answer/model_geometry.h"
#include "query/model_state.h"
#include "tools/cli/layer_option.h"
#include "tools/cli/size_text.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

struct LayerRow {
  std::string name;
  std::uint32_t layer = 0;
  bool is_there = false;
  std::uint32_t pages = 0;
  std::uint64_t bytes = 0;                          // stored
  std::uint64_t frame_bytes = 0;                    // of all its pages
  std::optional<std::uint64_t> min_budget_saved{};  // bytes
};

std::vector<LayerRow> layer_rows(const FileParts& parts) {
  const Sections sections = sections_of(parts);
  const std::uint32_t cap_pages = parts.first_field_page() - parts.first_cap_page();
  const std::uint32_t field_pages = parts.first_attribute_page() - parts.first_field_page();
  const std::uint32_t attribute_pages = parts.first_mask_page() - parts.first_attribute_page();
  const std::uint32_t side_pages = cap_pages + parts.page_count() - parts.first_mask_page();
  const std::uint64_t page_bytes = parts.header()->page_bytes;
  const std::uint32_t there = query::layers_of(parts.header()->model);
  const auto row = [&](std::uint32_t layer, std::uint32_t pages, std::uint64_t bytes) {
    const bool has_frames = layer != kFieldLayer;
    return LayerRow{layer_words(layer).front(),         layer, (there & layer) != 0, pages, bytes,
                    has_frames ? pages * page_bytes : 0};
  };
  std::vector<LayerRow> rows = {
      row(kDistanceLayer, parts.first_cap_page(), sections.distance_pages),
      row(kSideLayer, side_pages, sections.side_pages()),
      row(kFieldLayer, field_pages, sections.field_pages),
      row(kAttributeLayer, attribute_pages, sections.attribute_pages)};
  const auto all = min_budget_bytes(parts, kAllLayers);
  for (LayerRow& each : rows) {
    if (each.layer == kDistanceLayer || !each.is_there || !all) continue;
    if (const auto less = min_budget_bytes(parts, kAllLayers & ~each.layer))
      each.min_budget_saved = *all - *less;
  }
  return rows;
}

}  // namespace

std::optional<std::uint64_t> min_budget_bytes(const FileParts& parts, std::uint32_t layers) {
  OpenOptions options;
  options.max_probes = 1;
  options.layers = layers;
  const auto bytes = query::ModelState::min_budget_bytes(parts.path(), options);
  return bytes ? std::optional(*bytes) : std::nullopt;
}

Sections sections_of(const FileParts& parts) {
  Sections sections;
  sections.headers = 2 * storage::kHeaderBytes;
  sections.directory = storage::DirectoryShape(parts.page_count()).bytes();
  for (const storage::ExtensionRecord& record : parts.extensions())
    sections.extensions += sizeof record + record.bytes;
  for (std::uint32_t page = 0; page < parts.page_count(); ++page)
    (page < parts.first_cap_page()         ? sections.distance_pages
     : page < parts.first_field_page()     ? sections.cap_pages
     : page < parts.first_attribute_page() ? sections.field_pages
     : page < parts.first_mask_page()      ? sections.attribute_pages
                                      : sections.mask_pages) += parts.entries()[page].stored_bytes;
  return sections;
}

Json layers_json(const FileParts& parts) {
  Json json = Json::object();
  for (const LayerRow& row : layer_rows(parts)) {
    json[row.name] = nullptr;
    if (!row.is_there) continue;
    json[row.name] = {{"pages", row.pages}, {"bytes", row.bytes}, {"frame_bytes", row.frame_bytes}};
    if (row.layer == kDistanceLayer) continue;
    Json saved = nullptr;
    if (row.min_budget_saved) saved = *row.min_budget_saved;
    json[row.name]["min_budget_saved_bytes"] = saved;
  }
  return json;
}

std::string layers_line(const FileParts& parts) {
  std::string bytes, saved;
  for (const LayerRow& row : layer_rows(parts)) {
    if (row.layer == kAttributeLayer && !row.is_there) continue;  // most files have none
    bytes += bytes.empty() ? "" : ", ";
    bytes += row.is_there ? row.name + " " + short_bytes(row.bytes) : "no " + row.name;
    if (!row.min_budget_saved) continue;
    saved += saved.empty() ? "; left out at open, " : ", ";
    saved += fmt::format("{} saves {} of the minimum budget", row.name,
                         short_bytes(*row.min_budget_saved));
    if (row.frame_bytes > 0)
      saved += fmt::format(" and {} of frames for all pages", short_bytes(row.frame_bytes));
  }
  return fmt::format("  layers      {}{}\n", bytes, saved);
}

}  // namespace planetree::tools
