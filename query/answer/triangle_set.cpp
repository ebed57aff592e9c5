#include "query/answer/triangle_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/feature_normal.h"
#include "octree/nearest/interval_ends.h"
#include "octree/nearest/near_triangles.h"
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
    ClosestPoint answer;
    answer.distance = std::sqrt(result.value.squared);
    answer.triangle = index;
    if (answer.distance > radius_) return;
    if (is_full()) {
      is_cut_ = true;
      if (!is_before(answer, kept_.front())) return;
      std::pop_heap(kept_.begin(), kept_.end(), is_before);
      --count_;
    }
    describe(result, corners, answer);
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

  void describe(const octree::TriangleResult& result, const octree::Triangle& corners,
                ClosestPoint& answer) {
    octree::NearestOnTriangle nearest;
    octree::locate(corners, result, nearest);
    answer.lower = octree::lower_end(answer.distance - result.value.error);
    answer.upper = octree::upper_end(answer.distance + result.value.error);
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

void visit_triangles(const QueryContext& context, const TriangleSetQuery& query,
                     std::uint64_t count, const QueryOptions& options) noexcept {
  const octree::Point point = context.model.scale.in(query.centre);
  if (count == 0 || is_far(point)) return;
  octree::WorkLimit limit(context.work.units, max_units(options));
  DistancesKept kept(count, context.model.scale.in(std::min(query.radius, options.max_distance)));
  octree::near_triangles(context.model.tree, point, kept, limit, context.pages, context.work);
}

}  // namespace planetree::query
