#include "tools/view/scene_layout.h"

#include <map>
#include <utility>

namespace planetree::tools {

bool SceneLayout::read(const SceneDescription& description, const OpenedScene& opened,
                       SceneFailure& failure) {
  std::map<std::filesystem::path, std::size_t> numbers;
  for (std::size_t i = 0; i < description.instances.size(); ++i) {
    const InstanceDescription& instance = description.instances[i];
    const std::filesystem::path& path = description.models[instance.model].file;
    const auto [place, is_new] = numbers.emplace(path, files.size());
    if (is_new) {
      auto parts = ShapeReader::open_file(path);
      if (!parts) {
        failure = {path, parts.error()};
        return false;
      }
      files.push_back(*std::move(parts));
    }
    instances.push_back({place->second, {}});
    const ModelInfo& info = **opened.scene.info(opened.ids[i]);
    boxes.push_back(moved_box(instance.pose, {info.core_lower, info.core_upper}));
  }
  whole = box_around(boxes);
  frame = ShapeFrame::about(whole.lower, whole.upper);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    const ShapeFrame own = ShapeFrame::of(*files[instances[i].file].header());
    instances[i].place = ShapePlace(description.instances[i].pose, own, frame);
  }
  return true;
}

}  // namespace planetree::tools
