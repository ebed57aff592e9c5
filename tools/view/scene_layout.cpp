#include "tools/view/scene_layout.h"

#include <algorithm>
#include <map>
#include <utility>

namespace planetree::tools {
namespace {

/// The box around a box that a pose has moved.
WorldBox moved_box(const Pose& pose, const Vec3& lower, const Vec3& upper) {
  const octree::RigidTransform transform = *octree::RigidTransform::of(pose);
  const Vec3 half{0.5 * upper.x - 0.5 * lower.x, 0.5 * upper.y - 0.5 * lower.y,
                  0.5 * upper.z - 0.5 * lower.z};
  const Vec3 at = transform.apply({lower.x + half.x, lower.y + half.y, lower.z + half.z});
  const Vec3 reach = transform.rotate_extents(half);
  return {{at.x - reach.x, at.y - reach.y, at.z - reach.z},
          {at.x + reach.x, at.y + reach.y, at.z + reach.z}};
}

WorldBox box_around(const std::vector<WorldBox>& boxes) {
  WorldBox whole = boxes.front();
  for (const WorldBox& box : boxes) {
    whole.lower = {std::min(whole.lower.x, box.lower.x), std::min(whole.lower.y, box.lower.y),
                   std::min(whole.lower.z, box.lower.z)};
    whole.upper = {std::max(whole.upper.x, box.upper.x), std::max(whole.upper.y, box.upper.y),
                   std::max(whole.upper.z, box.upper.z)};
  }
  return whole;
}

}  // namespace

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
    boxes.push_back(moved_box(instance.pose, info.core_lower, info.core_upper));
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
