#include "query/answer/contact_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/best_triangle.h"
#include "octree/nearest/feature_normal.h"
#include "octree/nearest/interval_ends.h"
#include "octree/nearest/local_minima.h"
#include "octree/nearest/near_triangles.h"
#include "query/answer/closest_point.h"
#include "query/answer/fill_in.h"
#include "query/answer/missing_surface.h"
#include "query/answer/side.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Runs one search for contacts. The nearest one is that of closest_point().
class ContactQuery {
 public:
  ContactQuery(const QueryContext& context, const Vec3& centre, double radius,
               const QueryOptions& options, octree::ContactTriangles& triangles,
               std::span<ClosestPoint> found)
      : context_(context),
        model_(context.model),
        centre_(centre),
        point_(context.model.scale.in(centre)),
        radius_(std::min(radius, options.max_distance)),
        options_(options),
        tolerance_(context.model.scale.in(options.max_error)),
        triangles_(triangles),
        found_(found) {}

  ContactSet run() {
    if (found_.empty() || is_far(point_)) return {};
    find_nearest();
    const bool is_free = nearest_.status != Status::kDegraded && !(nearest_.distance <= radius_);
    if (is_free || nearest_.lower > radius_) return {{0, true}, false, nearest_incomplete_};
    const double wanted = model_.scale.in(radius_);
    triangles_.begin(certain(wanted + tolerance_));
    unread_ = clearance(model_, point_, false);
    while (find_round(wanted)) {
    }
    if (!is_cut_ && unread_ <= triangles_.reach()) is_degraded_ = true;
    restore_order();
    add_unseen_nearest();
    return {{count_, !is_degraded_ && !is_cut_},
            is_degraded_,
            nearest_incomplete_,
            std::min(radius_, model_.scale.out(triangles_.reach()))};
  }

 private:
  void find_nearest() {
    QueryOptions options = options_;
    options.parts |= kDistance;
    options.max_error = 0;
    options.max_distance = radius_;
    nearest_ = unanswered(Status::kExact);
    nearest_incomplete_ = closest_point(context_, centre_, options, nearest_, &side_);
  }

  std::uint64_t work_left() const {
    const std::uint64_t most = max_units(options_);
    return context_.work.units < most ? most - context_.work.units : 0;
  }

  // Finds the next triangles, and the contacts among them that they decide. Returns whether there
  // are more triangles to find.
  bool find_round(double wanted) {
    triangles_.begin_round();
    // What is found must also be sorted.
    octree::WorkLimit traversal(context_.work.units, work_left() - work_left() / kSortingShare);
    unread_ = std::min(unread_, octree::near_triangles(model_.tree, point_, triangles_, traversal,
                                                       context_.pages, context_.work));
    octree::WorkLimit limit(context_.work.units, work_left());
    if (!limit.take(triangles_.count() / octree::WorkUnits::kContactTriangles + 1)) {
      is_degraded_ = true;
      return false;
    }
    triangles_.join();
    octree::LocalMinima minima(triangles_, point_, tolerance_, limit);
    const double known = triangles_.known_within();
    std::size_t rank = 0;
    for (; rank < triangles_.count(); ++rank) {
      const octree::ContactTriangles::Entry& entry = triangles_.ranked(rank);
      if (entry.distance > wanted) break;
      const Position position(entry.squared, entry.index);
      if (position <= decided_) continue;
      const double level = certain(minima.level(rank));
      if (!is_proven(rank) && !(level < known)) break;
      if (!decide(minima, rank, level)) return false;
      decided_ = position;
    }
    // If not all triangles are known, the last one is never decided.
    if (known == kInfinity || triangles_.ranked(rank).distance > wanted) return false;
    return find_more(triangles_.ranked(rank).distance);
  }

  // Makes room for more triangles. Those that reach beyond a distance are still needed.
  bool find_more(double distance) {
    if (unread_ <= distance) is_degraded_ = true;
    const double needed = distance - tolerance_ - octree::kCoherenceSlack * (1 + distance);
    const bool goes_on = !is_degraded_ && triangles_.forget_before(point_, needed);
    is_cut_ |= !goes_on;
    return goes_on;
  }

  // Returns whether the search goes on.
  bool decide(octree::LocalMinima& minima, std::size_t rank, double level) {
    octree::NearestOnTriangle nearest;
    const auto kind = minima.kind(rank, nearest);
    if (kind == octree::LocalMinima::Kind::kUnknown) {
      is_degraded_ = true;
      return false;
    }
    has_seen_nearest_ |= triangles_.ranked(rank).index == nearest_.triangle;
    if (kind == octree::LocalMinima::Kind::kNone) return true;
    if (count_ == found_.size()) {
      is_cut_ = true;
      return false;
    }
    ClosestPoint& contact = found_[count_++];
    if (triangles_.ranked(rank).index == nearest_.triangle)
      contact = nearest_;
    else
      describe(rank, nearest, contact);
    if (!is_proven(rank) && !(level < unread_)) {
      contact.status = Status::kDegraded;
      is_degraded_ = true;
    }
    return true;
  }

  // Whether no triangle comes before, as closest_point() has found.
  bool is_proven(std::size_t rank) const {
    return nearest_.status == Status::kExact && triangles_.ranked(rank).index == nearest_.triangle;
  }
  // A triangle whose distance, as computed or bounded, exceeds the result is beyond `level`.
  double certain(double level) const {
    return octree::BestTriangle::reach_within(level, model_.tree.span(point_));
  }

  void describe(std::size_t rank, const octree::NearestOnTriangle& on_triangle,
                ClosestPoint& contact) {
    const octree::ContactTriangles::Entry& entry = triangles_.ranked(rank);
    octree::NearestAnswer nearest;
    static_cast<octree::NearestOnTriangle&>(nearest) = on_triangle;
    nearest.distance = entry.distance;
    nearest.lower = octree::lower_end(triangles_.lower_from(rank));
    nearest.upper = octree::upper_end(entry.distance + entry.error);
    nearest.triangle = entry.index;
    nearest.corners = entry.corners;
    nearest.status = Status::kDegraded;  // it is not the nearest of all
    contact = {};
    fill_in(model_.scale, nearest, contact);
    contact.status = Status::kExact;
    if ((options_.parts & kSide) != 0 || (options_.parts & kNormal) != 0) {
      contact.side = nearest_.side;
      if (contact.side == Side::kUnknown) contact.status = Status::kDegraded;
    }
    if ((options_.parts & kNormal) != 0) find_normal(nearest, contact);
  }

  // As ClosestPoint::normal states for a triangle that is not proven to be the nearest.
  void find_normal(const octree::NearestAnswer& nearest, ClosestPoint& contact) {
    octree::FrontSide front_side(point_);
    const bool by_front = options_.normal_rule == NormalRule::kTowardQuery;
    const octree::CoherenceCache* cache =
        may_use_coherence(context_.coherence, options_) ? &context_.coherence.nearest : nullptr;
    octree::FeatureNormal faces;
    octree::feature_normal(model_.tree, point_, nearest, cache, work_left(), context_.pages,
                           context_.work, faces, by_front ? &front_side : nullptr);
    octree::Point normal = faces.normal;
    bool is_known = faces.complete;
    if (by_front) {
      is_known &= faces.front != octree::Front::kUnknown;
      if (faces.front == octree::Front::kBehind) normal = -normal;
    } else if (model_.side_means(options_.side_rule) == SideMeans::kWindingNumber) {
      octree::WorkLimit limit(context_.work.units, work_left());
      normal = contact_normal(point_, nearest, faces, side_, limit);
      is_known &= side_.winding_is_known;
    }
    if (normal.squaredNorm() > 0) contact.normal = {normal.x(), normal.y(), normal.z()};
    if (!is_known) contact.status = Status::kDegraded;
  }

  static bool is_nearer(const ClosestPoint& left, const ClosestPoint& right) {
    return left.distance < right.distance;
  }

  // Puts contacts of a forged file in order, whose bounds may be wrong, so that rounds overlap.
  void restore_order() {
    const auto contacts = found_.first(count_);
    if (std::is_sorted(contacts.begin(), contacts.end(), is_nearer)) return;
    std::sort(contacts.begin(), contacts.end(), is_nearer);
    is_degraded_ = true;
  }

  // Adds the nearest point if its triangle was not found again: its page is missing by now, or the
  // work was spent.
  void add_unseen_nearest() {
    if (has_seen_nearest_ || nearest_.triangle == kNoTriangle || !(nearest_.distance <= radius_))
      return;
    is_degraded_ |= nearest_.status != Status::kExact || !is_cut_;
    const auto contacts = found_.first(count_);
    const auto at = std::upper_bound(contacts.begin(), contacts.end(), nearest_, is_nearer);
    if (at == found_.end()) return;
    if (count_ < found_.size()) ++count_;
    std::move_backward(at, found_.first(count_).end() - 1, found_.first(count_).end());
    *at = nearest_;
  }

  using Position = std::pair<double, std::uint64_t>;  // (value, index)
  static constexpr std::uint64_t kSortingShare = 8;   // of the work, for what is found

  const QueryContext& context_;
  const ModelGeometry& model_;
  const Vec3& centre_;
  const octree::Point point_;  // the centre in the model frame
  const double radius_;        // model units
  const QueryOptions& options_;
  const double tolerance_;
  octree::ContactTriangles& triangles_;
  const std::span<ClosestPoint> found_;
  std::size_t count_ = 0;
  ClosestPoint nearest_;
  bool nearest_incomplete_ = false;
  bool has_seen_nearest_ = false;
  SideResult side_;
  Position decided_{-1, 0};    // last triangle that was decided
  double unread_ = kInfinity;  // lower bound on the distance of triangles that were not read
  bool is_degraded_ = false;   // pages or work were missing
  bool is_cut_ = false;        // contacts did not fit, or triangles
};

}  // namespace

ContactSet find_contacts(const QueryContext& context, const Vec3& centre, double radius,
                         const QueryOptions& options, octree::ContactTriangles& triangles,
                         std::span<ClosestPoint> found) noexcept {
  return ContactQuery(context, centre, radius, options, triangles, found).run();
}

}  // namespace planetree::query
