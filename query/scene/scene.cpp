#include "planetree/scene.h"

#include <memory>
#include <new>
#include <utility>

#include "octree/geometry/fp_environment.h"
#include "query/scene/scene_probe.h"
#include "query/scene/scene_state.h"

namespace planetree {

Result<Scene> Scene::create(const SceneOptions& options) {
  const octree::FpEnvironmentGuard host;
  auto state = query::SceneState::create(options);
  if (!state) return state.error();
  return Scene(*std::move(state));
}

Scene::Scene(std::unique_ptr<query::SceneState> state) noexcept : state_(std::move(state)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

Result<InstanceId> Scene::add(const std::filesystem::path& path, const Pose& pose,
                              std::uint32_t layers) {
  const octree::FpEnvironmentGuard host;
  return state_->add(path, pose, layers);
}

Result<void> Scene::remove(InstanceId instance) { return state_->remove(instance); }

Result<void> Scene::set_pose(InstanceId instance, const Pose& pose, const Twist& twist) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->set_pose(instance, pose, twist);
}

Result<const ModelInfo*> Scene::info(InstanceId instance) const noexcept {
  return state_->info(instance);
}

Result<ModelMemory> Scene::memory(InstanceId instance) const noexcept {
  return state_->memory(instance);
}

SceneStats Scene::stats() const noexcept { return state_->stats(); }

Result<SceneProbe> SceneProbe::create(const Scene& scene) {
  auto reader = scene.state_->claim_probe();
  if (!reader) return reader.error();
  std::unique_ptr<query::SceneProbeState> state(
      new (std::nothrow) query::SceneProbeState(*scene.state_, *std::move(reader)));
  if (!state)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for a probe; free some and try again");
  return SceneProbe(std::move(state));
}

SceneProbe::SceneProbe(std::unique_ptr<query::SceneProbeState> state) noexcept
    : state_(std::move(state)) {}
SceneProbe::SceneProbe(SceneProbe&&) noexcept = default;
SceneProbe& SceneProbe::operator=(SceneProbe&&) noexcept = default;
SceneProbe::~SceneProbe() = default;

SceneClosestPoint SceneProbe::closest_point(Vec3 query, const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->closest_point(query, options);
}

SceneContainment SceneProbe::contains(Vec3 query, const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->contains(query, options);
}

SceneFirstContact SceneProbe::first_contact(const Sweep& sweep, double seconds,
                                            const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->first_contact(sweep, seconds, options);
}

Found SceneProbe::contacts(Vec3 query, double radius, std::span<SceneClosestPoint> found,
                           const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->contacts(query, radius, found, options);
}

SceneRayHit SceneProbe::first_hit(const Ray& ray, const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->first_hit(ray, options);
}

void SceneProbe::motion(Vec3 position, Vec3 velocity) noexcept {
  const octree::FpEnvironmentGuard host;
  state_->note_motion(position, velocity);
}

}  // namespace planetree
