#include "query/answer/triangle_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "octree/geometry/box_overlap.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/feature_normal.h"
#include "octree/nearest/interval_ends.h"
#include "octree/nearest/near_triangles.h"
#include "octree/traversal/tree_walk.h"
#include "query/answer/missing_surface.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_before(const ClosestPoint& left, const ClosestPoint& right) {
  return left.distance != right.distance ? left.distance < right.distance
                                         : left.triangle < right.triangle;
}

// Keeps the nearest triangles in the caller's memory, as a heap with the farthest first. Lengths
// are in the model frame until finish().
class NearestKept final : public octree::NearTriangleSink {
 public:
  /// wants_all  whether to find out if more triangles are within the radius than fit
  NearestKept(std::span<ClosestPoint> kept, double radius, bool wants_all, bool wants_normals,
              octree::WorkLimit& limit)
      : kept_(kept),
        radius_(radius),
        wants_all_(wants_all),
        wants_normals_(wants_normals),
        limit_(limit) {}

  double reach() const noexcept override {
    const bool suffices = is_full() && (is_cut_ || !wants_all_);
    return suffices ? std::min(radius_, kept_.front().distance) : radius_;
  }
  void take(const octree::TriangleResult& result, const octree::Triangle& corners,
            std::uint64_t index) noexcept override {
    take(result.value, corners, index,
         [&](octree::NearestOnTriangle& nearest) { octree::locate(corners, result, nearest); });
  }
  /// locate  locate(nearest) writes the nearest point
  template <class Locate>
  void take(const octree::TriangleValue& value, const octree::Triangle& corners,
            std::uint64_t index, const Locate& locate) {
    ClosestPoint answer;
    answer.distance = std::sqrt(value.squared);
    answer.triangle = index;
    if (answer.distance > radius_) return;
    if (is_full()) {
      is_cut_ = true;
      if (!is_before(answer, kept_.front())) return;
      std::pop_heap(kept_.begin(), kept_.end(), is_before);
      --count_;
    }
    octree::NearestOnTriangle nearest;
    locate(nearest);
    describe(nearest, corners, answer);
    kept_[count_++] = answer;
    const auto end = kept_.begin() + static_cast<std::ptrdiff_t>(count_);
    std::push_heap(kept_.begin(), end, is_before);
  }

  std::size_t count() const { return count_; }
  /// Whether more triangles are within the radius than fit.
  bool is_cut() const { return is_cut_; }
  std::span<ClosestPoint> sorted() {
    const auto kept = kept_.first(count_);
    std::sort_heap(kept.begin(), kept.end(), is_before);
    return kept;
  }

 private:
  bool is_full() const { return count_ == kept_.size(); }

  void describe(const octree::NearestOnTriangle& nearest, const octree::Triangle& corners,
                ClosestPoint& answer) {
    answer.lower = octree::lower_end(answer.distance - nearest.value.error);
    answer.upper = octree::upper_end(answer.distance + nearest.value.error);
    answer.point = {nearest.point.x(), nearest.point.y(), nearest.point.z()};
    answer.barycentric = {nearest.barycentric[0], nearest.barycentric[1], nearest.barycentric[2]};
    answer.feature = nearest.feature;
    if (!wants_normals_) return;
    octree::Point normal(0, 0, 1);
    double area2 = 0;
    octree::face_normal(corners, normal, area2, &limit_);
    answer.normal = {normal.x(), normal.y(), normal.z()};
  }

  const std::span<ClosestPoint> kept_;
  const double radius_;
  const bool wants_all_;
  const bool wants_normals_;
  octree::WorkLimit& limit_;
  std::size_t count_ = 0;
  bool is_cut_ = false;
};

// Keeps distances alone.
class DistancesKept final : public octree::NearTriangleSink {
 public:
  /// Of more triangles, all within the radius are visited.
  static constexpr std::size_t kMax = 256;

  DistancesKept(std::uint64_t wanted, double radius)
      : wanted_(wanted <= kMax ? static_cast<std::size_t>(wanted) : kMax + 1), radius_(radius) {}

  double reach() const noexcept override {
    return count_ == wanted_ ? std::min(radius_, farthest_.front()) : radius_;
  }
  void take(const octree::TriangleResult& result, const octree::Triangle&,
            std::uint64_t) noexcept override {
    if (wanted_ > kMax) return;
    const double distance = std::sqrt(result.value.squared);
    if (distance > reach()) return;
    if (count_ == wanted_) {
      std::pop_heap(farthest_.begin(), end());
      --count_;
    }
    farthest_[count_++] = distance;
    std::push_heap(farthest_.begin(), end());
  }

 private:
  std::array<double, kMax>::iterator end() {
    return farthest_.begin() + static_cast<std::ptrdiff_t>(count_);
  }

  const std::size_t wanted_;
  const double radius_;
  std::size_t count_ = 0;
  std::array<double, kMax> farthest_{};
};

// Converts an answer to model units.
void scale_out(const Scale& scale, ClosestPoint& answer) {
  answer.distance = scale.out(answer.distance);
  answer.lower = scale.out_below(answer.lower);
  answer.upper = scale.out_above(answer.upper);
  answer.point = scale.out(octree::Point(answer.point.x, answer.point.y, answer.point.z));
  if (!(answer.upper > answer.lower)) answer.upper = std::nextafter(answer.lower, kInfinity);
}

}  // namespace

TriangleSet find_triangles(const QueryContext& context, const TriangleSetQuery& query,
                           const QueryOptions& options, std::span<ClosestPoint> found) noexcept {
  const ModelGeometry& model = context.model;
  const octree::Point point = model.scale.in(query.centre);
  if (found.empty() || is_far(point)) return {{0, found.empty() && !query.wants_all}, false};
  octree::WorkLimit limit(context.work.units, max_units(options));
  const double radius = model.scale.in(std::min(query.radius, options.max_distance));
  NearestKept kept(found, radius, query.wants_all, (options.parts & kNormal) != 0, limit);
  const double unread =
      std::min(octree::near_triangles(model.tree, point, kept, limit, context.pages, context.work),
               clearance(model, point, false));
  const bool is_degraded = unread < kInfinity && unread <= kept.reach();
  for (ClosestPoint& answer : kept.sorted()) {
    // Of triangles that were not read, none can come before this one.
    answer.status = answer.upper < unread ? Status::kExact : Status::kDegraded;
    scale_out(model.scale, answer);
  }
  const bool is_complete = !is_degraded && !(query.wants_all && kept.is_cut());
  return {{kept.count(), is_complete}, is_degraded};
}

bool BoxSetQuery::is_valid() const {
  const auto is_range = [](double lower, double upper) {
    return std::isfinite(lower) && std::isfinite(upper) && lower <= upper;
  };
  return is_range(box_.lower.x, box_.upper.x) && is_range(box_.lower.y, box_.upper.y) &&
         is_range(box_.lower.z, box_.upper.z);
}

Vec3 BoxSetQuery::centre() const {
  const auto middle = [](double lower, double upper) { return lower / 2 + upper / 2; };
  return {middle(box_.lower.x, box_.upper.x), middle(box_.lower.y, box_.upper.y),
          middle(box_.lower.z, box_.upper.z)};
}

double BoxSetQuery::radius() const {
  const octree::Point lower(box_.lower.x, box_.lower.y, box_.lower.z);
  const octree::Point upper(box_.upper.x, box_.upper.y, box_.upper.z);
  // Of the box twice as large: the centre is rounded.
  return (upper - lower).norm();
}

TriangleSet find_triangles(const QueryContext& context, const BoxSetQuery& query,
                           const QueryOptions& options, std::span<ClosestPoint> found) noexcept {
  const ModelGeometry& model = context.model;
  const octree::Point point = model.scale.in(query.centre());
  const octree::Point lower = model.scale.in(query.box().lower);
  const octree::Point upper = model.scale.in(query.box().upper);
  if (found.empty() || is_far(point) || is_far(lower) || is_far(upper)) return {};
  octree::WorkLimit limit(context.work.units, max_units(options));
  NearestKept kept(found, model.scale.in(options.max_distance), true,
                   (options.parts & kNormal) != 0, limit);
  const auto take = [&](const octree::Triangle& corners, std::uint64_t index) {
    if (!limit.take(octree::WorkUnits::kBoxOverlap) ||
        !octree::touches_box(corners, lower, upper, limit) ||
        (octree::may_be_flat(corners) && !limit.take(octree::WorkUnits::kFlatFace)))
      return;
    ++context.work.triangles;
    const octree::NearestOnTriangle nearest = octree::nearest_on_triangle(point, corners);
    kept.take(nearest.value, corners, index,
              [&](octree::NearestOnTriangle& own) { own = nearest; });
  };
  // The tree's box has all triangles. Beyond it, float would overflow.
  octree::BoxWalk walk(model.tree, lower.cwiseMax(model.tree.box_lower - octree::Point::Ones()),
                       upper.cwiseMin(model.tree.box_upper + octree::Point::Ones()), context.pages,
                       context.work);
  const bool has_all = walk.run(limit.left(), [&](const octree::BlockView& block, std::uint32_t) {
    for (unsigned i = 0; i < block.header().triangle_count; ++i)
      take(block.triangle(i), block.id(i));
  });
  const bool is_degraded =
      !has_all || limit.exceeded() || !model.region.holds(lower) || !model.region.holds(upper);
  for (ClosestPoint& answer : kept.sorted()) {
    answer.status = is_degraded ? Status::kDegraded : Status::kExact;
    scale_out(model.scale, answer);
  }
  return {{kept.count(), !is_degraded && !kept.is_cut()}, is_degraded};
}

void visit_triangles(const QueryContext& context, const TriangleSetQuery& query,
                     std::uint64_t count, const QueryOptions& options) noexcept {
  const octree::Point point = context.model.scale.in(query.centre);
  if (count == 0 || is_far(point)) return;
  octree::WorkLimit limit(context.work.units, max_units(options));
  DistancesKept kept(count, context.model.scale.in(std::min(query.radius, options.max_distance)));
  octree::near_triangles(context.model.tree, point, kept, limit, context.pages, context.work);
}

}  // namespace planetree::query
