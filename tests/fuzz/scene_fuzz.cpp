#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "octree/geometry/rigid_transform.h"
#include "tests/fuzz/expectation.h"
#include "tools/scene/scene_description.h"

/// Reads arbitrary bytes as a scene file. What is accepted can be opened.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree;
  using namespace planetree::tools;
  const auto scene = parse_scene({reinterpret_cast<const char*>(bytes), size}, "folder");
  if (!scene) {
    expect(scene.error().code == ErrorCode::kBadInput);
    const std::string_view text = scene.error().text;
    expect(!text.empty() && text.find('\n') == std::string_view::npos);
    return 0;
  }
  expect(!scene->models.empty() && !scene->instances.empty());
  for (const ModelDescription& model : scene->models)
    expect(!model.file.empty() && (model.layers & kDistanceLayer) != 0);
  for (const InstanceDescription& instance : scene->instances) {
    expect(instance.model < scene->models.size());
    const Vec3& at = instance.pose.translation;
    const bool is_far = std::max({std::fabs(at.x), std::fabs(at.y), std::fabs(at.z)}) > 0x1p500;
    expect(octree::RigidTransform::of(instance.pose).has_value() || is_far);
  }
  return 0;
}
