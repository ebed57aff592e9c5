#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "cache/reader.h"
#include "planetree/scene.h"
#include "planetree/scene_shell.h"
#include "query/answer/query_context.h"
#include "query/scene/instance_view.h"
#include "query/scene/scene_state.h"

namespace planetree::query {

class SceneShellMemory;

/// The implementation of SceneProbe.
class SceneProbeState {
 public:
  /// scene   must outlive the probe
  /// reader  of SceneState::claim_probe()
  SceneProbeState(const SceneState& scene, cache::Reader reader) noexcept
      : reader_(std::move(reader)),
        scene_(scene),
        number_(scene.probe_of(reader_)),
        view_(scene.view(number_)) {}

  /// See the functions of SceneProbe.
  SceneClosestPoint closest_point(const Vec3& query, const QueryOptions& options) noexcept;
  SceneContainment contains(const Vec3& query, const QueryOptions& options) noexcept;
  SceneFirstContact first_contact(const Sweep& sweep, double seconds,
                                  const QueryOptions& options) noexcept;
  Found contacts(const Vec3& query, double radius, std::span<SceneClosestPoint> found,
                 const QueryOptions& options) noexcept;
  SceneRayHit first_hit(const Ray& ray, const QueryOptions& options) noexcept;
  /// See PointShell::wrench. `memory` is of the shell.
  Wrench wrench(SceneShellMemory& memory, const Pose& pose, const ShellOptions& options,
                std::span<SceneShellContact> contacts) noexcept;
  void note_motion(const Vec3& position, const Vec3& velocity) noexcept;

 private:
  class Section;
  class NearestSearch;
  class ContactSearch;
  class ContactSetSearch;
  class RaySearch;
  class ShellSum;

  /// A point in the frame of an instance.
  struct LocalPoint {
    Vec3 point;
    double error;  ///< bound on its distance from the true position
  };

  ProbeState& probe(std::size_t index) const noexcept {
    return view_.model(index).probe(reader_.index());
  }
  /// Runs a query of a probe, and takes its work from what is left.
  template <class Query>
  static auto spending(ProbeState& probe, QueryOptions& left, const Query& query) noexcept {
    const std::uint64_t before = probe.work_spent();
    const auto answer = query();
    spend(left, probe.work_spent() - before);
    return answer;
  }
  /// Whether a side cannot be told: a surface that is nearer than the error may lie between the
  /// query and its rounded position.
  static bool hides_side(const LocalPoint& local, std::uint32_t parts, double lower) noexcept {
    return local.error > 0 && (parts & (kSide | kNormal)) != 0 && lower <= local.error;
  }
  static void forget_side(ClosestPoint& answer) noexcept {
    answer.side = Side::kUnknown;
    answer.status = Status::kDegraded;
  }
  SceneContainment find_side(const Vec3& query, const QueryOptions& options) noexcept;
  Containment side_of(std::size_t index, const Vec3& query, QueryOptions& left) noexcept;
  static bool is_surface_near(ProbeState& probe, const LocalPoint& local,
                              QueryOptions options) noexcept;
  static LocalPoint to_local(const octree::RigidTransform& transform, const Vec3& point) noexcept;
  /// Moves an answer from the frame of an instance to the world.
  ///
  /// error  of the query point, see LocalPoint
  static void to_world(const octree::RigidTransform& transform, double error,
                       ClosestPoint& answer) noexcept;
  /// Whether a point can be brought into the frames of all instances.
  bool can_place(const Vec3& point) const noexcept;

  // First, so that it is destroyed last: then another probe may have the view.
  cache::Reader reader_;
  const SceneState& scene_;
  const std::uint32_t number_;
  InstanceView& view_;
  InstanceId last_instance_ = kNoInstance;  // that answered last
  std::size_t last_index_ = 0;              // it probably has
};

/// A section of the scene: while it lasts, the models that the view has are kept.
class SceneProbeState::Section {
 public:
  explicit Section(SceneProbeState& probe) noexcept : probe_(probe) {
    const std::uint64_t changes = probe.scene_.sections().enter(probe.number_);
    probe.view_.refresh(probe.scene_.slots(), changes);
  }
  ~Section() { probe_.scene_.sections().leave(probe_.number_); }
  Section(const Section&) = delete;
  Section& operator=(const Section&) = delete;

 private:
  SceneProbeState& probe_;
};

}  // namespace planetree::query
