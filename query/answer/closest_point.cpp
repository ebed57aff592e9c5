#include "query/answer/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/mask/mask_prefetcher.h"
#include "octree/nearest/feature_normal.h"
#include "octree/nearest/front_side.h"
#include "octree/nearest/height_field.h"
#include "query/answer/far_query.h"
#include "query/answer/fill_in.h"
#include "query/answer/missing_surface.h"
#include "query/answer/query_context.h"
#include "query/answer/sheet_side.h"
#include "query/answer/side.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Runs one closest-point query. Each stage is computed only when a later one needs it.
class ClosestPointQuery {
 public:
  ClosestPointQuery(const QueryContext& context, const Vec3& query, const QueryOptions& options,
                    ClosestPoint& answer)
      : model_(context.model),
        pages_(context.pages),
        coherence_(context.coherence),
        work_(context.work),
        query_(query),
        options_(options),
        max_units_(max_units(options)),
        remember_(may_use_coherence(coherence_, options)),
        remember_inexact_(may_remember_inexact(coherence_, options)),
        side_means_(model_.side_means(options.side_rule)),
        needs_front_(needs_front(options)),
        scaled_(model_.scale.in(query)),
        far_(is_far(scaled_)),
        point_(within_reach(scaled_, query)),
        answer_(answer) {}
  ~ClosestPointQuery() { stop_prefetch(); }
  ClosestPointQuery(const ClosestPointQuery&) = delete;
  ClosestPointQuery& operator=(const ClosestPointQuery&) = delete;

  // Returns whether a part is not exact because pages were missing or the work was spent.
  //
  // found  receives the side if it is a part; may be null
  bool run(SideResult* found) {
    const std::uint32_t parts = computed_parts(options_.parts);
    if (parts == kSide && !by_winding_number()) return find_side_alone();
    octree::NearestAnswer nearest =
        (parts & kDistance) != 0 ? find_nearest((parts & kSide) != 0) : octree::NearestAnswer();
    if ((parts & kDistance) != 0) report_nearest(nearest);
    const bool with_normal = (parts & kNormal) != 0 && answer_.triangle != kNoTriangle;
    const SideResult& side = (parts & kSide) != 0 ? find_side(nearest, with_normal) : side_result_;
    if (found) *found = side;
    if (with_normal)
      find_normal(nearest, side);
    else if ((parts & kNormal) != 0 && answer_.status != Status::kBeyondMaxDistance)
      find_direction(nearest);
    return incomplete_;
  }

 private:
  std::uint64_t work_left() const {
    return work_.units < max_units_ ? max_units_ - work_.units : 0;
  }

  bool by_winding_number() const { return side_means_ == SideMeans::kWindingNumber; }
  bool by_front() const { return side_means_ == SideMeans::kFront; }

  // Whether the query needs to know if it is in front of the nearest feature.
  bool needs_front(const QueryOptions& options) const {
    const std::uint32_t parts = computed_parts(options.parts);
    return (by_front() && (parts & kSide) != 0) ||
           (options.normal_rule == NormalRule::kTowardQuery && (parts & kNormal) != 0);
  }

  // Finds the side alone, by SideRule::kSurface or not at all.
  [[gnu::noinline]] bool find_side_alone() {
    if (!by_front()) {
      find_side({}, false);
      return incomplete_;
    }
    octree::NearestLimits limits;
    limits.max_work = options_.max_work;
    octree::NearestAnswer nearest = far_ ? farthest(model_.tree, point_) : search_nearest(limits);
    incomplete_ = nearest.status == Status::kDegraded;
    account_for_missing_surface(model_.tree, point_, clearance(model_, point_, far_),
                                limits.max_distance, nearest);
    find_side(nearest, false);
    return incomplete_;
  }

  // Starts to prefetch what the search for the side will read, if a search of the mask is likely.
  void start_prefetch() {
    if (!pages_.prefetch_hook || !coherence_.searched_side || !remember_ || far_ ||
        !by_winding_number() || model_.region.has_walls() || coherence_.side.same_side(point_, 0))
      return;
    prefetcher_.emplace(model_.mask, model_.side_grid, point_);
    if (prefetcher_->goes_on())
      *pages_.prefetch_hook = {&*prefetcher_, &octree::MaskPrefetcher::step_of};
  }
  void stop_prefetch() {
    if (prefetcher_) *pages_.prefetch_hook = {};
  }

  octree::NearestAnswer find_nearest(bool with_side) {
    if (far_) return farthest(model_.tree, point_);
    if (with_side) start_prefetch();
    octree::NearestLimits limits;
    limits.max_error = may_err() ? model_.scale.in(options_.max_error) : 0;
    limits.max_distance = model_.scale.in(options_.max_distance);
    limits.max_work = options_.max_work;
    // The direction to the field's point serves as a normal where that is far away.
    if ((computed_parts(options_.parts) & kNormal) != 0)
      limits.max_field_share = kMaxShareWithNormal;
    if (limits.max_error > 0 && is_exact_cheaper(limits)) {
      limits.prefers_exact = true;
      if (!limits.may_be_answered_by(coherence_.nearest.field())) limits.max_error = 0;
    }
    return search_nearest(limits);
  }

  // By the nearest feature the side belongs to the nearest triangle alone.
  bool may_err() const { return !by_front() || (computed_parts(options_.parts) & kSide) == 0; }

  // Whether an exact answer costs less than one within an error that the tree gives: near the last
  // query of a path.
  bool is_exact_cheaper(const octree::NearestLimits& limits) const {
    const octree::CoherenceCache& cache = coherence_.nearest;
    return (remember_inexact_ || (remember_ && limits.has_unlimited_work())) &&
           cache.course() == octree::CoherenceCache::Course::kPath &&
           cache.is_near_last(point_, model_.diagonal);
  }

  octree::NearestAnswer search_nearest(octree::NearestLimits& limits) {
    limits.field = &model_.field;
    if (remember_inexact_) limits.known = &coherence_.last_nearest;
    return octree::nearest(model_.tree, point_, limits, pages_, work_,
                           coherence_.is_on ? &coherence_.nearest : nullptr);
  }

  void report_nearest(octree::NearestAnswer& nearest) {
    stop_prefetch();
    // The answer of a far query has the sample, which is one vertex of a triangle.
    if (!far_ && remember_inexact_ && nearest.triangle != kNoTriangle)
      coherence_.last_nearest = nearest;
    incomplete_ = nearest.status == Status::kDegraded;
    account_for_missing_surface(model_.tree, point_, clearance(model_, point_, far_),
                                model_.scale.in(options_.max_distance), nearest);
    fill_in(model_.scale, nearest, answer_);
    accept_within_error(nearest);
    if (far_) measure_far(query_, options_, answer_);
    if (answer_.status == Status::kBeyondMaxDistance) answer_.lower = options_.max_distance;
    const bool is_within_error = answer_.upper - answer_.lower <= options_.max_error;
    if (answer_.status == Status::kDegraded && !incomplete_ && is_within_error)
      answer_.status = Status::kWithinError;
    // Scaling to subnormal model units rounds the interval outward by as much as its width.
    if (answer_.status == Status::kWithinError && !is_within_error) mark_degraded();
  }

  // Accepts an answer that lacks pages or work, sought as an exact one, if it is narrow enough.
  void accept_within_error(const octree::NearestAnswer& nearest) {
    if (!incomplete_ || !may_err() || nearest.triangle == kNoTriangle ||
        nearest.distance > nearest.upper || answer_.status != Status::kDegraded ||
        !(answer_.upper - answer_.lower <= options_.max_error))
      return;
    incomplete_ = false;
    answer_.status = Status::kWithinError;
  }

  const SideResult& find_side(const octree::NearestAnswer& nearest, bool with_normal) {
    const SideResult& side =
        by_winding_number() ? classify(nearest, with_normal) : classify_by_front(nearest);
    answer_.side = side.side;
    if (side.status == Status::kDegraded) mark_degraded();
    return side;
  }

  // Finds the side. Tries the cheapest rule first.
  const SideResult& classify(const octree::NearestAnswer& nearest, bool with_normal) {
    coherence_.searched_side = false;
    const SideResult& remembered = coherence_.side.side_result();
    if (!far_ && remember_ && is_cached_side(model_, point_, nearest.lower, coherence_.side))
      return remembered;
    octree::SideGrid::Lookup lookup;
    // Near the surface the nearest face decides most sides, elsewhere the side grid does.
    const bool grid_first = coherence_.side_grid_answered;
    if (grid_first && side_grid_decides(lookup)) return side_result_;
    if ((with_normal || nearest.feature == Feature::kFace) && faces_decide(nearest))
      return remembered;
    if (!grid_first && side_grid_decides(lookup)) return side_result_;
    coherence_.searched_side = true;
    side_result_ = remember_ ? query::find_side(model_, point_, lookup, nearest.lower,
                                                coherence_.side, work_left(), pages_, work_)
                             : query::find_side(model_, point_, work_left(), pages_, work_);
    return side_result_;
  }

  // Finds the side by SideRule::kSurface. By another rule it stays unknown.
  [[gnu::noinline]] const SideResult& classify_by_front(const octree::NearestAnswer& nearest) {
    const bool is_known = by_front() && !far_ && is_proven(model_.tree, nearest);
    return side_result_ = side_of(is_known ? front(nearest) : octree::Front::kUnknown);
  }

  octree::Front front(const octree::NearestAnswer& nearest) {
    if (!front_)
      front_ = front_at_surface(model_.tree, point_, nearest, work_left(), pages_, work_);
    if (!front_) front_ = feature(nearest).front;
    return *front_;
  }

  bool side_grid_decides(octree::SideGrid::Lookup& lookup) {
    std::optional<SideResult> known;
    if (far_) {
      // Decided for the query itself: point_ may be beyond another wall of a region.
      known =
          side_without_pages(model_, scaled_, look_up_side_grid(model_, scaled_, pages_.frames));
    } else if (remember_) {
      lookup = look_up_side_grid(model_, point_, pages_.frames);
      coherence_.side_grid_answered = lookup.winding != octree::SideGrid::kUnknown;
      known = side_without_pages(model_, point_, lookup);
    }
    if (known) side_result_ = *known;
    return known.has_value();
  }

  // Returns whether the faces at the nearest point decide the side. Not used by blocking queries of
  // limited work: they fetch the pages for other queries, which may have to search the mask. A
  // region with walls has no height fields, even if its file says so.
  bool faces_decide(const octree::NearestAnswer& nearest) {
    if (!remember_ || !octree::HeightField::tells_side(nearest) || model_.region.has_walls() ||
        !model_.cap_grid.is_clear_between(nearest.point, point_))
      return false;
    // Finding all faces at a vertex may visit many nodes. Enough must be left for the search.
    if (nearest.feature != Feature::kFace && work_left() < kNodesForFaces) return false;
    const int side = feature(nearest).side;
    if (side == 0) return false;
    coherence_.side.note(
        point_, {side > 0 ? Side::kOutside : Side::kInside, Status::kExact, side > 0 ? 0 : 1}, true,
        nearest.lower);
    return true;
  }

  void find_normal(const octree::NearestAnswer& nearest, const SideResult& side) {
    if (needs_front_) return find_normal_by_front(nearest);
    const octree::FeatureNormal& faces = feature(nearest);
    const SideResult oriented =
        side_for_normal(model_, point_, side, nearest.feature, work_left(), pages_, work_);
    octree::WorkLimit limit(work_.units, work_left());
    const octree::Point normal = contact_normal(point_, nearest, faces, oriented, limit);
    answer_.normal = {normal.x(), normal.y(), normal.z()};
    if (!faces.complete || !oriented.winding_is_known || limit.exceeded()) mark_degraded();
  }

  // Without a triangle the normal points from its point to the query or, by kOutward, outward.
  void find_direction(const octree::NearestAnswer& nearest) {
    octree::Point direction = point_ - nearest.point;
    if (answer_.side == Side::kInside && options_.normal_rule == NormalRule::kOutward)
      direction = -direction;
    // A forged field may hold points whose squared distances leave the range of doubles.
    const double largest = direction.cwiseAbs().maxCoeff();
    if (!(largest > 0 && largest < kInfinity)) return;
    direction = (direction / largest).normalized();
    answer_.normal = {direction.x(), direction.y(), direction.z()};
  }

  [[gnu::noinline]] void find_normal_by_front(const octree::NearestAnswer& nearest) {
    const octree::FeatureNormal& faces = feature(nearest);
    octree::Point normal = faces.normal;
    if (!(normal.squaredNorm() > 0)) normal = {0, 0, 1};
    if (!faces.complete) mark_degraded();
    if (options_.normal_rule == NormalRule::kTowardQuery) {
      if (front(nearest) == octree::Front::kUnknown) mark_degraded();
      if (front(nearest) == octree::Front::kBehind) normal = -normal;
    }
    answer_.normal = {normal.x(), normal.y(), normal.z()};
  }

  [[gnu::noinline]] void find_feature_and_front(const octree::NearestAnswer& nearest) {
    octree::FrontSide front_side(point_);
    octree::feature_normal(model_.tree, point_, nearest, remember_ ? &coherence_.nearest : nullptr,
                           work_left(), pages_, work_, feature_, &front_side);
  }

  const octree::FeatureNormal& feature(const octree::NearestAnswer& nearest) {
    if (!has_feature_ && needs_front_)
      find_feature_and_front(nearest);
    else if (!has_feature_)
      octree::feature_normal(model_.tree, point_, nearest,
                             remember_ ? &coherence_.nearest : nullptr, work_left(), pages_, work_,
                             feature_);
    has_feature_ = true;
    return feature_;
  }

  void mark_degraded() {
    incomplete_ = true;
    pages_.need_others();
    if (answer_.status != Status::kBeyondMaxDistance) answer_.status = Status::kDegraded;
  }

  static constexpr double kMaxShareWithNormal = 0.125;  // width by distance of a field's answer
  static constexpr std::uint64_t kNodesForFaces = 512;  // minimum of work left to look for faces

  const ModelGeometry& model_;
  const octree::PageReader& pages_;
  Coherence& coherence_;
  octree::TraversalStats& work_;
  const Vec3& query_;
  const QueryOptions& options_;
  const std::uint64_t max_units_;
  const bool remember_;
  const bool remember_inexact_;
  const SideMeans side_means_;  // what decides the side
  const bool needs_front_;
  const octree::Point scaled_;  // the query in the model frame
  const bool far_;
  const octree::Point point_;  // scaled_; for a far query see within_reach()
  std::optional<octree::MaskPrefetcher> prefetcher_;
  ClosestPoint& answer_;
  octree::FeatureNormal feature_;  // at the nearest point, if has_feature_
  bool has_feature_ = false;
  std::optional<octree::Front> front_;  // empty until found
  SideResult side_result_;              // a side that is not in the side cache
  bool incomplete_ = false;
};

}  // namespace

bool closest_point(const QueryContext& context, const Vec3& query, const QueryOptions& options,
                   ClosestPoint& answer, SideResult* side) noexcept {
  return ClosestPointQuery(context, query, options, answer).run(side);
}

}  // namespace planetree::query
