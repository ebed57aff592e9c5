#include "tools/view/scene_facts.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "tools/cli/layer_words.h"
#include "tools/cli/subcommand.h"
#include "tools/scene/scene_report.h"
#include "tools/view/view_json.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

Json instance_json(const SceneDescription& description, const SceneLayout& layout,
                   std::size_t index) {
  const InstanceDescription& instance = description.instances[index];
  const ShapePlace& place = layout.instances[index].place;
  const Quaternion& q = place.rotation();
  return {{"name", instance.name},
          {"model", description.models[instance.model].name},
          {"box_lower", vector_json(layout.boxes[index].lower)},
          {"box_upper", vector_json(layout.boxes[index].upper)},
          {"rotation", {q.w, q.x, q.y, q.z}},
          {"offset", vector_json(place.offset())},
          {"scale", number_json(place.scale())}};
}

/// The models that have instances, with the number of these.
Json models_json(const SceneDescription& description, const OpenedScene& opened) {
  std::vector<std::uint64_t> counts(description.models.size());
  std::vector<std::size_t> first(description.models.size());
  for (std::size_t i = opened.ids.size(); i-- > 0;) {
    ++counts[description.instances[i].model];
    first[description.instances[i].model] = i;
  }
  Json models = Json::array();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const ModelDescription& model = description.models[i];
    const ModelInfo& info = **opened.scene.info(opened.ids[first[i]]);
    models.push_back({{"name", model.name},
                      {"file", model.file.filename().string()},
                      {"triangles", info.triangles},
                      {"pages", info.pages},
                      {"instances", counts[i]},
                      {"layers", layer_words(info.layers & model.layers)},
                      {"memory_bytes", memory_json(*opened.scene.memory(opened.ids[first[i]]))}});
  }
  return models;
}

}  // namespace

std::string scene_info_json(const std::string& name, const SceneDescription& description,
                            const OpenedScene& opened, const SceneLayout& layout) {
  Json instances = Json::array();
  std::uint64_t triangles = 0;
  for (std::size_t i = 0; i < opened.ids.size(); ++i) {
    instances.push_back(instance_json(description, layout, i));
    triangles += (*opened.scene.info(opened.ids[i]))->triangles;
  }
  const SceneStats stats = opened.scene.stats();
  return json_line({{"file", name},
                    {"triangles", triangles},
                    {"core_lower", vector_json(layout.whole.lower)},
                    {"core_upper", vector_json(layout.whole.upper)},
                    {"centre", vector_json(layout.frame.centre)},
                    {"unit", number_json(layout.frame.unit)},
                    {"memory_bytes", stats.budget_bytes},
                    {"frames", stats.frames},
                    {"arena_bytes", stats.arena_bytes},
                    {"model_bytes", stats.model_bytes},
                    {"table_bytes", stats.table_bytes},
                    {"models", models_json(description, opened)},
                    {"instances", std::move(instances)}});
}

std::string scene_stats_json(const SceneStats& stats) {
  return json_line({{"loaded", stats.pages_read},
                    {"evicted", stats.pages_evicted},
                    {"resident", stats.pages_read - stats.pages_evicted},
                    {"frames", stats.frames},
                    {"page_hits", stats.page_hits},
                    {"page_misses", stats.page_misses},
                    {"fetch_requests_served", stats.fetch_requests_served},
                    {"quarantined_pages", stats.quarantined_pages}});
}

}  // namespace planetree::tools
