#include "query/answer/closest_point.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

#include "octree/geometry/strict_math.h"
#include "octree/nearest/feature_normal.h"
#include "octree/nearest/height_field.h"
#include "query/answer/contact_normal.h"
#include "query/answer/query_rules.h"
#include "query/answer/side.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// As if no triangle was reached; `answer` is new.
void begin(ClosestPoint& answer, Status status) {
  answer.distance = answer.upper = kInfinity;
  answer.status = status;
}

// Beyond octree::kFarthestQuery all triangles are equally far in double; `from`
// there stands for a query in its direction that is farther.
octree::NearestAnswer farthest(const octree::TreeInfo& tree, const octree::Point& from) {
  octree::NearestAnswer nearest;
  nearest.point = nearest.corners[0] = tree.sample;
  nearest.triangle = tree.sample_triangle;
  nearest.distance = from.norm();
  nearest.barycentric = {1, 0, 0};
  nearest.feature = Feature::kVertex;
  nearest.status = Status::kExact;
  return nearest;
}

// In model units, where the frame's could overflow.
void measure_far(const Vec3& query, const QueryOptions& options, ClosestPoint& answer) {
  const double largest = std::max({std::fabs(query.x), std::fabs(query.y), std::fabs(query.z)});
  const double x = query.x / largest, y = query.y / largest, z = query.z / largest;
  answer.distance = largest * std::sqrt(x * x + y * y + z * z);
  if (answer.distance > options.max_distance) {
    answer = {};
    begin(answer, Status::kBeyondMaxDistance);
    answer.lower = options.max_distance;
    return;
  }
  answer.upper = answer.distance * (1 + 0x1p-48);
  answer.lower = std::min(answer.distance, std::numeric_limits<double>::max()) * (1 - 0x1p-48);
}

// How far the surface is that was left out of a file of a region: at least so far, and all of its
// triangles would be found to be. Nothing is known where the point itself is out of reach.
double clearance(const octree::Region& region, const octree::Point& point, bool far) {
  if (!region.has_walls()) return kInfinity;
  return far ? 0 : region.clearance(point);
}

// What the nearest of a region's triangles says of the whole surface, which is nowhere nearer
// than those or `clear`.
void widen(const octree::TreeInfo& tree, const octree::Point& point, double clear,
           double max_distance, octree::NearestAnswer& nearest) {
  const bool beyond = nearest.status == Status::kBeyondMaxDistance;
  if (beyond ? max_distance <= clear : nearest.upper < clear) return;
  // Something that was left out may be nearer.
  nearest.lower = std::max(0.0, std::min(nearest.lower, clear));
  nearest.status = Status::kDegraded;
  if (!beyond) return;
  nearest.point = tree.sample;
  nearest.upper = (point - tree.sample).norm() * (1 + 0x1p-48) + 0x1p-500;
  nearest.distance = nearest.upper;
  nearest.feature = Feature::kVertex;
}

void fill_in(const Scale& scale, const octree::NearestAnswer& nearest, ClosestPoint& answer) {
  answer.distance = scale.out(nearest.distance);
  answer.lower = std::min(scale.out_below(nearest.lower), std::numeric_limits<double>::max());
  answer.upper = scale.out_above(nearest.upper);
  if (!(answer.upper > answer.lower)) answer.upper = std::nextafter(answer.lower, kInfinity);
  answer.point = scale.out(nearest.point);
  answer.triangle = nearest.triangle;
  answer.barycentric = {nearest.barycentric[0], nearest.barycentric[1], nearest.barycentric[2]};
  answer.feature = nearest.feature;
  answer.status = nearest.status;
}

// The parts of one ask, each when another needs it.
class ClosestPointQuery {
 public:
  /// stop    what the ask is given up for, if it waits for pages; may be null.
  /// answer  that of an ask that reached no triangle: run() fills in what is asked for.
  ClosestPointQuery(ProbeState& probe, const Vec3& query, const QueryOptions& options,
                    const std::atomic<bool>* stop, ClosestPoint& answer)
      : probe_(probe),
        model_(probe.model()),
        query_(query),
        options_(with_defaults(options)),
        remember_(may_use_coherence(options)),
        scaled_(model_.scale().in(query)),
        far_(is_far(scaled_)),
        point_(within_reach(scaled_, query)),
        accessor_(probe.reader(), options.wait,
                  stop ? model_.fetcher_terms() : model_.query_terms(), stop),
        answer_(answer) {
    accessor_.set_trace(probe.touches().begin_query(options.wait));
  }

  void run() {
    const std::uint32_t parts = (options_.parts & kNormal) != 0 ? kAllParts : options_.parts;
    octree::NearestAnswer nearest =
        (parts & kDistance) != 0 ? find_nearest((parts & kSide) != 0) : octree::NearestAnswer();
    if ((parts & kDistance) != 0) tell(nearest);
    const bool with_normal = (parts & kNormal) != 0 && answer_.triangle != kNoTriangle;
    const SideResult& side_result =
        (parts & kSide) != 0 ? find_side(nearest, with_normal) : side_result_;
    if (with_normal) find_normal(nearest, side_result);
    if (lost_) note_loss(probe_, query_, options_, accessor_);
    probe_.last_parts() = parts;
  }

 private:
  std::uint64_t work_left() const {
    const std::uint64_t spent = work_.nodes + work_.blocks;
    return spent < options_.max_work ? options_.max_work - spent : 0;
  }

  // To what tells the side, if it is likely to take a search of the mask.
  void look_ahead() {
    if (!probe_.searched_side() || !remember_ || far_ || model_.region().has_walls() ||
        probe_.side_cache().same_side(point_, 0))
      return;
    prefetcher_.emplace(model_.mask(), model_.side_grid(), point_);
    if (prefetcher_->goes_on()) accessor_.set_prefetcher(&*prefetcher_);
  }

  octree::NearestAnswer find_nearest(bool with_side) {
    if (far_) return farthest(model_.tree(), point_);
    if (with_side) look_ahead();
    octree::NearestLimits limits;
    limits.max_error = model_.scale().in(options_.max_error);
    limits.max_distance = model_.scale().in(options_.max_distance);
    limits.max_work = options_.max_work;
    if (options_.wait == Wait::kNever) limits.known = &probe_.last_nearest();
    return octree::nearest(model_.tree(), point_, limits, accessor_.pages(), work_,
                           &probe_.coherence_cache());
  }

  void tell(octree::NearestAnswer& nearest) {
    accessor_.set_prefetcher(nullptr);
    // What stands for the farthest queries' nearest triangle is a vertex of it.
    if (!far_ && options_.wait == Wait::kNever && nearest.triangle != kNoTriangle)
      probe_.last_nearest() = nearest;
    lost_ = nearest.status == Status::kDegraded;
    widen(model_.tree(), point_, clearance(model_.region(), point_, far_),
          model_.scale().in(options_.max_distance), nearest);
    fill_in(model_.scale(), nearest, answer_);
    if (far_) measure_far(query_, options_, answer_);
    if (answer_.status == Status::kBeyondMaxDistance) answer_.lower = options_.max_distance;
    if (answer_.status == Status::kDegraded && !lost_ &&
        answer_.upper - answer_.lower <= options_.max_error)
      answer_.status = Status::kWithinError;
  }

  const SideResult& find_side(const octree::NearestAnswer& nearest, bool with_normal) {
    const SideResult& side_result = classify(nearest, with_normal);
    answer_.side = side_result.side;
    if (side_result.status == Status::kDegraded) degrade();
    return side_result;
  }

  // By whatever is quickest to tell.
  const SideResult& classify(const octree::NearestAnswer& nearest, bool with_normal) {
    probe_.searched_side() = false;
    const SideResult& remembered = probe_.side_cache().side_result();
    if (is_side_as_before(nearest)) return remembered;
    octree::SideGrid::Lookup lookup;
    // Faces tell most sides near the surface, colours those of other places.
    const bool looks_first = probe_.side_grid_answered();
    if (looks_first && tell_side_at_a_look(lookup)) return side_result_;
    if ((with_normal || nearest.feature == Feature::kFace) && faces_tell_side(nearest))
      return remembered;
    if (!looks_first && tell_side_at_a_look(lookup)) return side_result_;
    probe_.searched_side() = true;
    side_result_ =
        side_of(probe_, point_, lookup, nearest.lower, remember_, work_left(), accessor_, work_);
    return side_result_;
  }

  // Most often the side is that of the ask before: the surface is known to be farther than that
  // was.
  bool is_side_as_before(const octree::NearestAnswer& nearest) {
    return !far_ && remember_ &&
           query::is_side_as_before(model_, point_, nearest.lower, probe_.side_cache());
  }

  bool tell_side_at_a_look(octree::SideGrid::Lookup& lookup) {
    std::optional<SideResult> known;
    if (far_) {
      // What stands for a point that far away may be beyond another wall of a region.
      known = side_without_pages(model_, scaled_,
                                 look_up_side_grid(model_, scaled_, frames_of(probe_.reader())));
    } else if (remember_) {
      lookup = look_up_side_grid(model_, point_, frames_of(probe_.reader()));
      probe_.side_grid_answered() = lookup.winding != octree::SideGrid::kUnknown;
      known = side_without_pages(model_, point_, lookup);
    }
    if (known) side_result_ = *known;
    return known.has_value();
  }

  // The side by what is at the nearest point, and no look at the mask. Not of limited asks that
  // wait: they bring the pages that others need, which may have to look there. No region with
  // walls has sheets, whatever its file says.
  bool faces_tell_side(const octree::NearestAnswer& nearest) {
    if (!remember_ || !octree::HeightField::tells_side(nearest) || model_.region().has_walls())
      return false;
    // Of a few nodes more than finding all faces of a vertex takes, the search shall have its own.
    if (nearest.feature != Feature::kFace && work_left() < kNodesForFaces) return false;
    const int side = feature(nearest).side;
    if (side == 0) return false;
    const SideResult side_result{side > 0 ? Side::kOutside : Side::kInside, Status::kExact,
                                 side > 0 ? 0 : 1};
    probe_.side_cache().note(point_, side_result, true, nearest.lower);
    return true;
  }

  void find_normal(const octree::NearestAnswer& nearest, const SideResult& side_result) {
    const octree::Point normal = contact_normal(point_, nearest, feature(nearest), side_result);
    answer_.normal = {normal.x(), normal.y(), normal.z()};
    if (!feature(nearest).complete) degrade();
  }

  const octree::FeatureNormal& feature(const octree::NearestAnswer& nearest) {
    if (!has_feature_)
      octree::feature_normal(model_.tree(), point_, nearest,
                             remember_ ? &probe_.coherence_cache() : nullptr, work_left(),
                             accessor_.pages(), work_, feature_);
    has_feature_ = true;
    return feature_;
  }

  void degrade() {
    lost_ = true;
    if (answer_.status != Status::kBeyondMaxDistance) answer_.status = Status::kDegraded;
  }

  static constexpr std::uint64_t kNodesForFaces = 512;

  ProbeState& probe_;
  const ModelState& model_;
  const Vec3& query_;
  const QueryOptions options_;
  const bool remember_;
  const octree::Point scaled_;
  const bool far_;
  const octree::Point point_;
  std::optional<octree::MaskPrefetcher> prefetcher_;
  PageAccessor accessor_;
  octree::TraversalStats work_;
  ClosestPoint& answer_;
  octree::FeatureNormal feature_;  // at the nearest point, once it was asked for
  bool has_feature_ = false;
  SideResult side_result_;  // where the probe need not remember it
  bool lost_ = false;       // something for want of pages or work
};

}  // namespace

ClosestPoint closest_point(ProbeState& probe, const Vec3& query,
                           const QueryOptions& options) noexcept {
  // One answer, made where the caller wants it.
  ClosestPoint answer;
  const bool sensible = is_valid(query, options);
  begin(answer, sensible ? Status::kExact : Status::kBadQuery);
  if (sensible) ClosestPointQuery(probe, query, options, nullptr, answer).run();
  if (answer.status == Status::kDegraded) probe.model().count_degraded();
  return answer;
}

void bring_pages(ProbeState& probe, const Vec3& query, const QueryOptions& options,
                 const std::atomic<bool>& stop) noexcept {
  assert(options.wait == Wait::kForPages && !may_use_coherence(options));
  if (!is_valid(query, options)) return;
  ClosestPoint unused;
  begin(unused, Status::kExact);
  ClosestPointQuery(probe, query, options, &stop, unused).run();
}

}  // namespace planetree::query
