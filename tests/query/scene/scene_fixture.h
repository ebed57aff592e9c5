#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>

#include "octree/geometry/rigid_transform.h"
#include "planetree/scene.h"
#include "tests/query/sample_model.h"

namespace planetree::query {

/// Scenes of a few spheres and tubes in small pages.
class SceneFixture : public testing::Test {
 protected:
  static SceneOptions small_options() {
    SceneOptions options;
    options.memory_budget_bytes = std::uint64_t{8} << 20;
    options.max_page_bytes = 4096;
    options.max_probes = 2;
    options.max_instances = 128;
    options.locking = Locking::kNever;
    return options;
  }
  static Scene make_scene(const SceneOptions& options = small_options()) {
    auto scene = Scene::create(options);
    EXPECT_TRUE(scene) << scene.error().text;
    return std::move(*scene);
  }
  static InstanceId add(Scene& scene, const SampleModel& model, const Pose& pose = {},
                        std::uint32_t layers = kAllLayers) {
    const auto added = scene.add(model.path(), pose, layers);
    EXPECT_TRUE(added) << added.error().text;
    return added ? *added : kNoInstance;
  }
  static SceneProbe make_probe(const Scene& scene) {
    auto probe = SceneProbe::create(scene);
    EXPECT_TRUE(probe) << probe.error().text;
    return std::move(*probe);
  }
  static Pose at(double x, double y = 0, double z = 0) { return {{}, {x, y, z}}; }
  /// A pose that turns about an axis.
  static Pose turned(double x, double turn) {
    return {{std::sqrt(1 - turn * turn), 0.6 * turn, 0, 0.8 * turn}, {x, 0.3, -0.2}};
  }

  const SampleModel ball_ = SampleModel::masked(octree::sphere(4));
  const SampleModel fine_ball_ = SampleModel::masked(octree::sphere(5));
};

}  // namespace planetree::query
