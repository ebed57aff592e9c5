#include "tools/scene/scene_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/check/file_parts.h"
#include "tools/cli/layer_words.h"
#include "tools/cli/size_text.h"
#include "tools/report/layer_report.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

// A scene with all layers of the models that leave some out.
class WholeScene {
 public:
  /// The memory of a model with all layers.
  Result<ModelMemory> measure(const SceneDescription& description, const ModelDescription& model,
                              std::uint64_t budget_bytes) {
    if (!scene_) {
      std::filesystem::path failed;
      const auto options = options_for(description, {.memory_budget_bytes = budget_bytes}, failed);
      if (!options) return options.error();
      auto scene = Scene::create(*options);
      if (!scene) return scene.error();
      scene_.emplace(*std::move(scene));
    }
    const auto id = scene_->add(model.file);
    if (!id) return id.error();
    const auto memory = scene_->memory(*id);
    if (const auto removed = scene_->remove(*id); !removed) return removed.error();
    return memory;
  }

 private:
  std::optional<Scene> scene_;
};

Result<std::vector<LayerLeftOut>> layers_left_out(const ModelDescription& model) {
  std::vector<LayerLeftOut> left_out;
  if (model.layers == kAllLayers) return left_out;
  const auto parts = FileParts::open(model.file);
  if (!parts) return parts.error();
  const Json layers = layers_json(*parts);
  for (const std::string& name : layer_words(kAllLayers & ~model.layers))
    if (const Json& layer = layers[name]; !layer.is_null())
      left_out.push_back({name, layer["pages"], layer["bytes"]});
  return left_out;
}

std::string left_out_text(const ModelShare& share) {
  std::string text;
  for (const LayerLeftOut& layer : share.left_out)
    text += fmt::format("{}{} ({} pages, {})", text.empty() ? "" : ", ", layer.name,
                        grouped_count(layer.pages), short_bytes(layer.bytes));
  if (text.empty()) return text;
  return fmt::format("    left out: {}, never read; saves {} of memory besides pages\n", text,
                     short_bytes(share.saved_bytes));
}

}  // namespace

Json memory_json(const ModelMemory& memory) {
  return {{"total", memory.total}, {"directory", memory.directory}, {"side_grid", memory.side_grid},
          {"field", memory.field}, {"probes", memory.probes},       {"other", memory.other}};
}

bool measure_shares(const SceneDescription& description, const OpenedScene& opened,
                    std::vector<ModelShare>& shares, SceneFailure& failure) {
  WholeScene whole;
  const auto fail = [&failure](const ModelDescription& model, const Error& error) {
    failure = {model.file, error};
    return false;
  };
  for (std::size_t index = 0; index < description.models.size(); ++index) {
    const ModelDescription& model = description.models[index];
    ModelShare share;
    share.model = &model;
    for (std::size_t i = 0; i < opened.ids.size(); ++i) {
      if (description.instances[i].model != index) continue;
      if (share.instances++ > 0) continue;
      share.triangles = (*opened.scene.info(opened.ids[i]))->triangles;
      share.memory = *opened.scene.memory(opened.ids[i]);
    }
    if (share.instances == 0) continue;
    auto left_out = layers_left_out(model);
    if (!left_out) return fail(model, left_out.error());
    share.left_out = *std::move(left_out);
    if (!share.left_out.empty()) {
      const auto all = whole.measure(description, model, opened.scene.stats().budget_bytes);
      if (!all) return fail(model, all.error());
      share.saved_bytes = all->total - share.memory.total;
    }
    shares.push_back(std::move(share));
  }
  return true;
}

std::string scene_text(const std::string& file, const SceneDescription& description,
                       const OpenedScene& opened, const std::vector<ModelShare>& shares) {
  const SceneStats stats = opened.scene.stats();
  std::string text = fmt::format(
      "{}: {} instances of {} models in {}\n"
      "  frames {}, models besides pages {}, all else {}\n",
      octree::printable(file), grouped_count(stats.instances), grouped_count(stats.models),
      short_bytes(stats.budget_bytes), short_bytes(stats.arena_bytes),
      short_bytes(stats.model_bytes), short_bytes(stats.table_bytes));
  for (const ModelShare& share : shares) {
    const ModelMemory& memory = share.memory;
    text += fmt::format(
        "  {}: {}, {} triangles, {} instances, layers {}\n"
        "    besides pages {}: directory {}, side grid {}, field {}, probes {}, other {}\n",
        octree::printable(share.model->name), octree::printable(share.model->file.string()),
        grouped_count(share.triangles), grouped_count(share.instances),
        layers_text(share.model->layers), short_bytes(memory.total), short_bytes(memory.directory),
        short_bytes(memory.side_grid), short_bytes(memory.field), short_bytes(memory.probes),
        short_bytes(memory.other));
    text += left_out_text(share);
  }
  for (std::size_t i = 0; i < opened.ids.size(); ++i) {
    const InstanceDescription& instance = description.instances[i];
    if (!instance.name.empty())
      text += fmt::format("  instance {}: {}, of {}\n", i, octree::printable(instance.name),
                          octree::printable(description.models[instance.model].name));
  }
  return text;
}

Json scene_json(const std::string& file, const SceneDescription& description,
                const OpenedScene& opened, const std::vector<ModelShare>& shares) {
  const SceneStats stats = opened.scene.stats();
  Json json = {{"file", file},
               {"budget_bytes", stats.budget_bytes},
               {"frames", stats.frames},
               {"arena_bytes", stats.arena_bytes},
               {"model_bytes", stats.model_bytes},
               {"table_bytes", stats.table_bytes},
               {"models", Json::array()},
               {"instances", Json::array()}};
  for (const ModelShare& share : shares) {
    Json left_out = Json::array();
    for (const LayerLeftOut& layer : share.left_out)
      left_out.push_back({{"layer", layer.name}, {"pages", layer.pages}, {"bytes", layer.bytes}});
    json["models"].push_back({{"name", share.model->name},
                              {"file", share.model->file.string()},
                              {"triangles", share.triangles},
                              {"instances", share.instances},
                              {"layers", layer_words(share.model->layers)},
                              {"memory_bytes", memory_json(share.memory)},
                              {"left_out", left_out},
                              {"saved_bytes", share.saved_bytes}});
  }
  for (const InstanceDescription& instance : description.instances)
    json["instances"].push_back(
        {{"name", instance.name}, {"model", description.models[instance.model].name}});
  return json;
}

}  // namespace planetree::tools
