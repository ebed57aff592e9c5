#include "octree/nearest/local_minima.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"

namespace planetree::octree {
namespace {

// Corners that edge k joins.
constexpr unsigned kEdgeCorners[3] = {0b011, 0b110, 0b101};

unsigned next_of(unsigned k) { return k == 2 ? 0 : k + 1; }

// Returns a bit for each corner of `triangle` that `other` has too.
unsigned shared_corners(const Triangle& triangle, const Triangle& other) {
  unsigned shared = 0;
  for (unsigned k = 0; k < 3; ++k)
    if (triangle[k] == other[0] || triangle[k] == other[1] || triangle[k] == other[2])
      shared |= 1U << k;
  return shared;
}

}  // namespace

LocalMinima::LocalMinima(const ContactTriangles& triangles, const Point& query, double tolerance,
                         WorkLimit& limit)
    : triangles_(triangles), query_(query), tolerance_(tolerance), limit_(limit) {}

// Points on edges are rounded, and so are corners that should lie on an edge.
double LocalMinima::tolerance_of(const ContactTriangles::Entry& entry) const {
  const double largest =
      std::max(greatest_corner(entry.corners).maxCoeff(), -least_corner(entry.corners).minCoeff());
  return tolerance_ + kContactErrors * entry.error + kContactRounding * largest;
}

double LocalMinima::level(std::size_t rank) const {
  const ContactTriangles::Entry& entry = triangles_.ranked(rank);
  return entry.distance + tolerance_of(entry);
}

LocalMinima::Kind LocalMinima::kind(std::size_t rank, NearestOnTriangle& nearest) {
  if (has_earlier_at_feature(rank)) return limit_.exceeded() ? Kind::kUnknown : Kind::kNone;
  const Kind kind = search(rank);
  if (kind != Kind::kMinimum) return kind;
  const Triangle& corners = triangles_.ranked(rank).corners;
  if (!take_distance(corners)) return Kind::kUnknown;
  nearest = nearest_on_triangle(query_, corners);
  const bool touches = touches_earlier(rank, nearest.point);
  if (limit_.exceeded()) return Kind::kUnknown;
  return touches ? Kind::kNone : Kind::kMinimum;
}

// Whether a triangle that comes before has the edge or vertex that the nearest point is on. This
// decides for most triangles.
bool LocalMinima::has_earlier_at_feature(std::size_t rank) {
  const std::size_t entry = triangles_.entry_of(rank);
  const unsigned feature = triangles_.entry(entry).feature;
  const Triangle& corners = triangles_.entry(entry).corners;
  if (std::popcount(feature) == 3) return false;
  const std::size_t start = 3 * entry + static_cast<unsigned>(std::countr_zero(feature));
  for (std::size_t at = triangles_.next_at_vertex(start); at != start;
       at = triangles_.next_at_vertex(at)) {
    if (!take_steps(1)) return true;
    if (triangles_.rank_of(at / 3) < rank &&
        (shared_corners(corners, triangles_.entry(at / 3).corners) & feature) == feature)
      return true;
  }
  return false;
}

// Visits all triangles that a path below the level leads to, until one comes before.
LocalMinima::Kind LocalMinima::search(std::size_t rank) {
  const double level = this->level(rank);
  begin_ = rank;
  queue_[0] = static_cast<std::uint16_t>(triangles_.entry_of(rank));
  reached_ = 1;
  is_reached_[queue_[0]] = true;
  bool leads_back = false;
  for (std::size_t i = 0; i < reached_ && !leads_back && !limit_.exceeded(); ++i) {
    const ContactTriangles::Entry& entry = triangles_.entry(queue_[i]);
    unsigned near_edges = 0, near_vertices = 0;
    for (unsigned k = 0; k < 3; ++k) {
      const Point& corner = entry.corners[k];
      // Its nearest point is below the level, so that its own feature is.
      const bool is_vertex = entry.feature == 1U << k, is_edge = entry.feature == kEdgeCorners[k];
      if (is_vertex || is_within(corner, corner, level)) near_vertices |= 1U << k;
      if (is_edge || is_within(corner, entry.corners[next_of(k)], level)) near_edges |= 1U << k;
    }
    for (unsigned k = 0; k < 3 && !leads_back; ++k)
      leads_back = visit_vertex(queue_[i], k, near_edges, (near_vertices >> k & 1) != 0);
  }
  for (std::size_t i = 0; i < reached_; ++i) is_reached_[queue_[i]] = false;
  if (limit_.exceeded()) return Kind::kUnknown;
  return leads_back ? Kind::kNone : Kind::kMinimum;
}

// Goes to the triangles that share corner k of an entry. Returns whether one of them comes before.
bool LocalMinima::visit_vertex(std::size_t entry, unsigned k, unsigned near_edges, bool is_near) {
  const Triangle& corners = triangles_.entry(entry).corners;
  const std::size_t start = 3 * entry + k;
  for (std::size_t at = triangles_.next_at_vertex(start); at != start;
       at = triangles_.next_at_vertex(at)) {
    if (!take_steps(1)) return false;
    const std::size_t other = at / 3;
    if (is_reached_[other]) continue;
    bool is_joined = is_near;
    if (!is_joined) {
      const unsigned shared = shared_corners(corners, triangles_.entry(other).corners);
      is_joined = shared == 0b111;
      for (unsigned edge = 0; edge < 3; ++edge)
        is_joined |=
            (near_edges >> edge & 1) != 0 && (shared & kEdgeCorners[edge]) == kEdgeCorners[edge];
    }
    if (!is_joined) continue;
    if (triangles_.rank_of(other) < begin_) return true;
    is_reached_[other] = true;
    queue_[reached_++] = static_cast<std::uint16_t>(other);
  }
  return false;
}

// Whether a point of the segment is within a distance of the query, as far as double tells: a point
// that errs along the segment is on it all the same.
bool LocalMinima::is_within(const Point& a, const Point& b, double distance) const {
  const Point along = b - a, from = query_ - a;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp(from.dot(along) / length2, 0.0, 1.0) : 0;
  return (from - share * along).squaredNorm() <= distance * distance;
}

bool LocalMinima::touches_earlier(std::size_t rank, const Point& point) {
  const double tolerance = tolerance_of(triangles_.ranked(rank));
  for (std::size_t other = 0; other < rank; ++other) {
    if (!take_steps(1)) return false;
    const Triangle& corners = triangles_.ranked(other).corners;
    const Point gap =
        (least_corner(corners) - point).cwiseMax(point - greatest_corner(corners)).cwiseMax(0.0);
    if (gap.maxCoeff() > tolerance) continue;
    if (!take_distance(corners)) return false;
    if (std::sqrt(triangle_value(point, corners).squared) <= tolerance) return true;
  }
  return false;
}

bool LocalMinima::take_distance(const Triangle& triangle) {
  return limit_.take(may_be_flat(triangle) ? WorkUnits::kFlatFace : 1);
}

bool LocalMinima::take_steps(unsigned steps) {
  steps_ += steps;
  if (steps_ < WorkUnits::kContactSteps) return true;
  steps_ = 0;
  return limit_.take();
}

}  // namespace planetree::octree
