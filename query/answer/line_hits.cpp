#include "query/answer/line_hits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/feature_normal.h"
#include "octree/nearest/near_triangles.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_before(const RayHit& left, const RayHit& right) {
  return left.t != right.t ? left.t < right.t : left.triangle < right.triangle;
}

// Keeps the first hits in the caller's memory, as a heap with the last first. Positions are those
// of the way.
class FirstKept final : public octree::CorridorSink {
 public:
  /// range  of the way in which there are triangles
  FirstKept(const ModelLine& way, const octree::LineRange& range, bool wants_all,
            std::span<RayHit> kept, octree::WorkLimit& limit)
      : way_(way), range_(range), wants_all_(wants_all), kept_(kept), limit_(limit) {}

  double reach() const noexcept override {
    return way_.length_between(range_.lower, last_wanted()) + way_.error_at(range_.upper);
  }
  void take(const octree::Triangle& corners, std::uint64_t index) noexcept override {
    const octree::LineCrossing crossing =
        octree::cross(way_.line(), way_.range(), corners, &limit_);
    if (limit_.exceeded() || crossing.sign == 0) return;
    RayHit hit;
    hit.t = crossing.t;
    hit.t_lower = std::max(0.0, (crossing.t - crossing.error) * (1 - octree::kEndRounding));
    hit.t_upper = (crossing.t + crossing.error) * (1 + octree::kEndRounding) +
                  std::numeric_limits<double>::min();
    hit.triangle = index;
    hit.entering = crossing.sign > 0;
    lower_ = std::min(lower_, hit.t_lower);
    upper_ = std::min(upper_, hit.t_upper);
    if (is_full()) {
      is_cut_ = true;
      if (!is_before(hit, kept_.front())) return;
      std::pop_heap(kept_.begin(), kept_.end(), is_before);
      --count_;
    }
    describe(corners, hit);
    kept_[count_++] = hit;
    std::push_heap(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(count_), is_before);
  }

  std::size_t count() const { return count_; }
  bool is_cut() const { return is_cut_; }
  double lower() const { return lower_; }
  double upper() const { return upper_; }
  /// Corners of the hit that was kept last.
  const octree::Triangle& corners() const { return corners_; }
  /// Position beyond which no hit is wanted.
  double last_wanted() const {
    if (!is_full() || (wants_all_ && !is_cut_)) return range_.upper;
    return std::min(range_.upper, kept_.front().t_upper);
  }
  std::span<RayHit> sorted() {
    const auto kept = kept_.first(count_);
    std::sort_heap(kept.begin(), kept.end(), is_before);
    return kept;
  }

 private:
  bool is_full() const { return count_ == kept_.size(); }

  // Not refused: a hit that is known has its place.
  void describe(const octree::Triangle& corners, RayHit& hit) {
    limit_.take_some(octree::WorkUnits::kDescription);
    const octree::NearestOnTriangle nearest = octree::nearest_on_triangle(way_.at(hit.t), corners);
    hit.point = {nearest.point.x(), nearest.point.y(), nearest.point.z()};
    hit.barycentric = {nearest.barycentric[0], nearest.barycentric[1], nearest.barycentric[2]};
    octree::Point normal(0, 0, 1);
    double area2 = 0;
    octree::face_normal(corners, normal, area2);
    hit.normal = {normal.x(), normal.y(), normal.z()};
    corners_ = corners;
  }

  const ModelLine& way_;
  const octree::LineRange range_;
  const bool wants_all_;
  const std::span<RayHit> kept_;
  octree::WorkLimit& limit_;
  std::size_t count_ = 0;
  bool is_cut_ = false;
  double lower_ = kInfinity, upper_ = kInfinity;
  octree::Triangle corners_{};
};

// Converts a hit to the caller's positions and model units.
void scale_out(const Scale& scale, const ModelLine& way, RayHit& hit) {
  hit.t = way.out(hit.t);
  hit.t_lower = way.out_below(hit.t_lower);
  hit.t_upper = way.out_above(hit.t_upper);
  hit.point = scale.out(octree::Point(hit.point.x, hit.point.y, hit.point.z));
}

}  // namespace

LineHits find_hits(const QueryContext& context, const ModelLine& way, bool wants_all,
                   const QueryOptions& options, std::span<RayHit> hits) noexcept {
  const ModelGeometry& model = context.model;
  const double begin = way.range().lower;
  if (way.is_far() || hits.empty()) return {{0, false}, begin, kInfinity, way.is_far()};
  octree::WorkLimit limit(context.work.units, max_units(options));
  const octree::LineRange range = way.within(model.tree.box_lower, model.tree.box_upper, 0);
  FirstKept kept(way, range, wants_all, hits, limit);
  double unread = kInfinity;  // a position before which nothing that was not read is hit
  if (range.lower <= range.upper) {
    const octree::Corridor corridor{way.at(range.lower), way.at(range.upper),
                                    way.error_at(range.upper)};
    const double distance =
        triangles_in_corridor(model.tree, corridor, kept, limit, context.pages, context.work);
    if (distance < kInfinity)
      unread = way.position_after(range.lower, distance - way.error_at(range.upper));
  }
  if (limit.exceeded()) unread = begin;
  const double end = kept.last_wanted() < range.upper ? kept.last_wanted() : way.range().upper;
  const double clear = clear_length(model, way, end, 0);
  if (clear < kInfinity) unread = std::min(unread, way.position_after(begin, clear));
  const bool is_degraded = unread < kInfinity && unread <= end;
  for (RayHit& hit : kept.sorted()) {
    hit.status = !is_degraded || hit.t_upper < unread ? Status::kExact : Status::kDegraded;
    scale_out(model.scale, way, hit);
  }
  const bool is_complete = !is_degraded && !(wants_all && kept.is_cut());
  return {{kept.count(), is_complete},
          is_degraded ? std::min(unread, kept.lower()) : kept.lower(),
          kept.upper(),
          is_degraded,
          kept.corners()};
}

// Barycentric coordinates err by about 2^-53 over the square of the height's share, 2^-29, and are
// at least 2^-8. The crossing of the other way is less than 2^-24 of the edge away, the edges of
// the triangle at least 2^-20.
double crossing_tolerance(const octree::Triangle& corners, const Vec3& barycentric,
                          double cosine) noexcept {
  constexpr double kMinShare = 0x1p-8, kMinCosine = 0x1p-8, kMinHeight = 0x1p-12;
  constexpr double kTolerance = 0x1p-33;  // 2^-24 over 2 / kMinCosine
  const double edge = std::sqrt(
      std::max({(corners[1] - corners[0]).squaredNorm(), (corners[2] - corners[1]).squaredNorm(),
                (corners[0] - corners[2]).squaredNorm()}));
  const bool is_inside = std::min({barycentric.x, barycentric.y, barycentric.z}) >= kMinShare;
  octree::Point normal(0, 0, 1);
  double area2 = 0;
  octree::face_normal(corners, normal, area2);
  const bool is_sound = cosine >= kMinCosine && std::sqrt(area2) >= kMinHeight * edge * edge;
  return is_inside && is_sound && edge > octree::kUnresolvedLength ? kTolerance * edge : 0;
}

FirstHit first_hit(const QueryContext& context, ModelLine way,
                   const QueryOptions& options) noexcept {
  const bool is_shortened = way.end_after(context.model.scale.in(options.max_distance));
  RayHit hit;
  const LineHits found = find_hits(context, way, false, options, {&hit, 1});
  const bool is_beyond = found.found.count == 0 && is_shortened;
  const double lower = is_beyond ? std::min(found.lower, way.range().upper) : found.lower;
  hit.t_lower = way.out_below(lower);
  hit.t_upper = way.out_above(found.upper);
  hit.status = found.is_degraded ? Status::kDegraded
               : is_beyond       ? Status::kBeyondMaxDistance
                                 : Status::kExact;
  return {hit, found.is_degraded, found.corners};
}

}  // namespace planetree::query
