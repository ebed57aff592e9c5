#include "query/scene/instance_view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "query/scene/scene_model.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Relative error of a t at which a ray enters a box: a difference and a quotient err by 2 u;
// times 4.
constexpr double kClipRounding = 0x1p-50;

double length_above(const Vec3& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}) * 2;
}

}  // namespace

void InstanceView::cut(cache::ArenaLayout& layout, std::uint32_t max_instances,
                       InstanceView& view) {
  view.ids_ = layout.cut<InstanceId>(max_instances);
  view.models_ = layout.cut<const SceneModel*>(max_instances);
  view.versions_ = layout.cut<std::uint64_t>(max_instances);
  view.placements_ = layout.cut<Placement>(max_instances);
  for (std::span<double>& corners : view.boxes_) corners = layout.cut<double>(max_instances);
  view.keys_ = layout.cut<double>(max_instances);
}

void InstanceView::refresh(std::span<const InstanceSlot> slots, std::uint64_t changes) noexcept {
  if (changes == changes_) return;
  changes_ = changes;
  is_still_ = true;
  size_ = 0;
  for (const InstanceSlot& slot : slots) {
    const SceneModel* const model = slot.model.load(std::memory_order_seq_cst);
    if (!model) continue;
    const InstanceId id{slot.id.load(std::memory_order_relaxed)};
    if (ids_[size_] != id || models_[size_] != model) {
      ids_[size_] = id;
      models_[size_] = model;
      versions_[size_] = 0;
    }
    load(size_++, slot);
  }
}

// A placement that is being written is read after the next change, which its writer counts.
void InstanceView::load(std::size_t index, const InstanceSlot& slot) noexcept {
  if (slot.placement.load_newer(versions_[index], placements_[index])) {
    place_box(index);
  } else if (!is_placed(index)) {
    for (std::size_t i = 0; i < kCorners; ++i) boxes_[i][index] = i < 3 ? -kInfinity : kInfinity;
  }
  is_still_ = is_still_ && is_placed(index) && transform(index).is_identity();
}

// The box of the turned box of the model. Rounding of the box itself is far below the error of a
// position, but for the default pose, where there is none.
void InstanceView::place_box(std::size_t index) noexcept {
  const ModelInfo& info = models_[index]->info;
  const octree::RigidTransform transform = this->transform(index);
  Vec3 lower = info.box_lower, upper = info.box_upper;
  if (!transform.is_identity()) {
    const Vec3 half{(upper.x - lower.x) / 2, (upper.y - lower.y) / 2, (upper.z - lower.z) / 2};
    const Vec3 centre = transform.apply({lower.x + half.x, lower.y + half.y, lower.z + half.z});
    const Vec3 extents = transform.rotate_extents(half);
    const double reach = length_above(lower) + length_above(upper);
    // Of the centre, of the extents, and of the sums and differences here.
    const double error = 4 * transform.position_error(reach) +
                         0x1p-50 * (length_above(centre) + length_above(extents));
    lower = {centre.x - extents.x - error, centre.y - extents.y - error,
             centre.z - extents.z - error};
    upper = {centre.x + extents.x + error, centre.y + extents.y + error,
             centre.z + extents.z + error};
  }
  const double corners[kCorners] = {lower.x, lower.y, lower.z, upper.x, upper.y, upper.z};
  for (std::size_t i = 0; i < kCorners; ++i) boxes_[i][index] = corners[i];
}

std::size_t InstanceView::find(InstanceId id, std::size_t likely) const noexcept {
  if (likely < size_ && ids_[likely] == id) return likely;
  const auto ids = ids_.first(size_);
  return static_cast<std::size_t>(std::find(ids.begin(), ids.end(), id) - ids.begin());
}

double InstanceView::reach(std::size_t index) const noexcept {
  const ModelInfo& info = models_[index]->info;
  return length_above(info.box_lower) + length_above(info.box_upper);
}

bool InstanceView::overlaps(std::size_t index, const Vec3& lower, const Vec3& upper,
                            double way) const noexcept {
  const double corners[kCorners] = {lower.x, lower.y, lower.z, upper.x, upper.y, upper.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Not the negation, so that infinities that cancel overlap.
    const double before = boxes_[axis][index] - corners[axis + 3];
    const double behind = corners[axis] - boxes_[axis + 3][index];
    if (before * (1 - octree::kEndRounding) > way || behind * (1 - octree::kEndRounding) > way)
      return false;
  }
  return true;
}

void InstanceView::compute_bounds(const Vec3& point) noexcept {
  octree::squared_box_distances(boxes_, point, keys_.first(size_));
}

double InstanceView::least_key() const noexcept { return octree::least_value(keys_.first(size_)); }

octree::LineRange InstanceView::range_in_box(std::size_t index, const Ray& ray) const noexcept {
  octree::LineRange range{ray.t_min, ray.t_max};
  const double origin[] = {ray.origin.x, ray.origin.y, ray.origin.z};
  const double direction[] = {ray.direction.x, ray.direction.y, ray.direction.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double first = boxes_[axis][index] - origin[axis];
    const double last = boxes_[axis + 3][index] - origin[axis];
    if (direction[axis] == 0) {
      if (first > 0 || last < 0) return {1, 0};
      continue;
    }
    const bool is_upward = direction[axis] > 0;
    const double entry = (is_upward ? first : last) / direction[axis];
    const double exit = (is_upward ? last : first) / direction[axis];
    range.lower = std::max(range.lower, entry - std::fabs(entry) * kClipRounding);
    range.upper = std::min(range.upper, exit + std::fabs(exit) * kClipRounding);
  }
  return range;
}

void InstanceView::compute_entries(const Ray& ray) noexcept {
  for (std::size_t index = 0; index < size_; ++index) {
    const octree::LineRange range = range_in_box(index, ray);
    keys_[index] = range.lower <= range.upper ? range.lower : kInfinity;
  }
}

double InstanceView::least_bound() const noexcept { return bound_of(least_key()); }

std::size_t InstanceView::nearest() const noexcept {
  const double least = least_key();
  if (least == kInfinity) return size_;
  const auto all = keys_.first(size_);
  return static_cast<std::size_t>(std::find(all.begin(), all.end(), least) - all.begin());
}

double InstanceView::bound_of(double squared) noexcept {
  // See squared_box_distances() for the error of the square.
  return squared < 0x1p-1000 ? 0 : std::sqrt(squared) * (1 - 0x1p-49);
}

void InstanceView::mark_visited(std::size_t index) noexcept { keys_[index] = kInfinity; }

}  // namespace planetree::query
