#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "cache/prefaulted_memory.h"
#include "octree/geometry/box_distances.h"
#include "octree/geometry/line_crossing.h"
#include "octree/geometry/rigid_transform.h"
#include "planetree/contact.h"
#include "planetree/scene.h"
#include "planetree/types.h"
#include "query/scene/instance_table.h"

namespace planetree::query {

/// The instances of a scene as one probe last saw them, with their boxes in the world frame. One
/// thread at a time may use it. It lies in the memory of the scene.
class InstanceView {
 public:
  /// Takes memory for so many instances from a layout. `view` is left empty while that measures.
  static void cut(cache::ArenaLayout& layout, std::uint32_t max_instances, InstanceView& view);

  /// Reads what has changed. Call it inside of a section of the scene (SceneSections), so that
  /// models that it finds are kept until the section ends.
  ///
  /// slots    those in use
  /// changes  number of changes of the scene; if it is that of the last call, nothing is read
  void refresh(std::span<const InstanceSlot> slots, std::uint64_t changes) noexcept;

  /// Number of instances. Those below have an index less than that, in the order of their slots.
  std::size_t size() const noexcept { return size_; }
  InstanceId id(std::size_t index) const noexcept { return ids_[index]; }
  const SceneModel& model(std::size_t index) const noexcept { return *models_[index]; }
  /// False if the instance was being moved whenever this view looked. Its place is then not known.
  bool is_placed(std::size_t index) const noexcept { return versions_[index] != 0; }
  const Placement& placement(std::size_t index) const noexcept { return placements_[index]; }
  octree::RigidTransform transform(std::size_t index) const noexcept {
    return *octree::RigidTransform::of(placements_[index].pose);
  }
  /// Bound on the distance of the surface from the origin of the instance.
  double reach(std::size_t index) const noexcept;
  /// Whether all poses are the default one.
  bool is_still() const noexcept { return is_still_; }
  /// Returns the index of an instance, or size() if it is gone.
  std::size_t find(InstanceId id, std::size_t likely) const noexcept;

  /// Returns whether the box of an instance, widened by `way`, and another box have a common point.
  bool overlaps(std::size_t index, const Vec3& lower, const Vec3& upper, double way) const noexcept;
  /// Computes lower bounds of the distances of all instances from a point, for the calls below.
  void compute_bounds(const Vec3& point) noexcept;
  /// Returns the least bound of the instances that are not marked as visited; infinite if all are.
  double least_bound() const noexcept;
  /// Computes for all instances a lower bound of the t at which a ray enters the box, infinite if
  /// it does not meet the box. The calls below are then about these bounds.
  void compute_entries(const Ray& ray) noexcept;
  /// The entry of an instance that is not visited.
  double entry(std::size_t index) const noexcept { return keys_[index]; }
  /// Returns bounds of the t at which a ray is in the box of an instance: within [t_min, t_max],
  /// and lower > upper if there is none.
  octree::LineRange range_in_box(std::size_t index, const Ray& ray) const noexcept;

  /// Returns the first instance of the least bound; size() if all are visited.
  std::size_t nearest() const noexcept;
  /// Lower bound of the distance of an instance that is not visited; 0 if the point is in its box.
  double bound(std::size_t index) const noexcept { return bound_of(keys_[index]); }
  void mark_visited(std::size_t index) noexcept;

 private:
  static double bound_of(double squared) noexcept;
  double least_key() const noexcept;
  void load(std::size_t index, const InstanceSlot& slot) noexcept;
  void place_box(std::size_t index) noexcept;

  static constexpr std::size_t kCorners = 6;  // lower x, y, z, upper x, y, z

  std::span<InstanceId> ids_;
  std::span<const SceneModel*> models_;
  std::span<std::uint64_t> versions_;  // of the placement, see SeqLock
  std::span<Placement> placements_;
  octree::BoxColumns boxes_;
  std::span<double> keys_;  // squares of bounds, or entries; infinite: visited
  std::size_t size_ = 0;
  std::uint64_t changes_ = 0;
  bool is_still_ = true;
};

}  // namespace planetree::query
