#include "tests/oracle/queries/contact_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace planetree::oracle {
namespace {

using Real = long double;
using Point = std::array<Real, 3>;

// Margins as shares of the scale. The library's tolerance lies between them: it is at least
// 2^-49 of the coordinates, and below 2^-40 of the distances unless triangles are needles.
constexpr Real kNothing = 1e-17L, kCertain = 1e-11L;

Point wide(const Vec3& p) { return {p.x, p.y, p.z}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Real dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point along(const Point& a, const Point& direction, Real t) {
  return {a[0] + t * direction[0], a[1] + t * direction[1], a[2] + t * direction[2]};
}
bool same(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
bool has(const Corners& triangle, const Vec3& corner) {
  return same(triangle[0], corner) || same(triangle[1], corner) || same(triangle[2], corner);
}

// The nearest point of a segment to a point.
Point nearest_on_segment(const Point& query, const Point& a, const Point& b) {
  const Point ab = b - a;
  const Real length2 = dot(ab, ab);
  const Real t = length2 > 0 ? dot(query - a, ab) / length2 : 0;
  return t <= 0 ? a : t >= 1 ? b : along(a, ab, t);
}

// The nearest point of a triangle: its face's where the projection falls inside, else an edge's.
Point nearest_on(const Point& query, const std::array<Point, 3>& corner) {
  const Point normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
  bool inside = dot(normal, normal) > 0;
  Real best = std::numeric_limits<Real>::infinity();
  Point nearest{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Point &a = corner[k], &b = corner[(k + 1) % 3];
    inside = inside && dot(cross(b - a, query - a), normal) > 0;
    const Point on_edge = nearest_on_segment(query, a, b);
    const Real squared = dot(on_edge - query, on_edge - query);
    if (squared < best) {
      best = squared;
      nearest = on_edge;
    }
  }
  if (!inside) return nearest;
  const Real height = dot(query - corner[0], normal) / dot(normal, normal);
  const Point on_face = along(query, normal, -height);
  return dot(on_face - query, on_face - query) < best ? on_face : nearest;
}

}  // namespace

ContactOracle::Part ContactOracle::vertex_part(const Vec3& corner) const {
  return edge_part(corner, corner);
}

// Computed in one direction, so that all triangles of the edge get the same bits.
ContactOracle::Part ContactOracle::edge_part(const Vec3& a, const Vec3& b) const {
  const Point query = wide(query_);
  const bool swapped = Key(b.x, b.y, b.z) < Key(a.x, a.y, a.z);
  const Point point = swapped ? nearest_on_segment(query, wide(b), wide(a))
                              : nearest_on_segment(query, wide(a), wide(b));
  return {std::sqrt(dot(point - query, point - query)), point};
}

ContactOracle::Part ContactOracle::triangle_part(std::size_t triangle) const {
  const Corners& corners = triangles_[triangle];
  const Point query = wide(query_);
  Part part = edge_part(corners[0], corners[1]);
  for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
    const Part edge = edge_part(corners[k], corners[(k + 1) % 3]);
    if (edge.distance < part.distance) part = edge;
  }
  const Point point = nearest_on(query, {wide(corners[0]), wide(corners[1]), wide(corners[2])});
  const Real distance = std::sqrt(dot(point - query, point - query));
  return distance < part.distance * (1 - 1e-18L) ? Part{distance, point} : part;
}

ContactOracle::ContactOracle(const Vec3& query, std::span<const Corners> triangles)
    : query_(query), triangles_(triangles) {
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    parts_.push_back(triangle_part(i));
    edges_.emplace_back();
    vertices_.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& corner = triangles[i][k];
      edges_[i][k] = edge_part(corner, triangles[i][(k + 1) % 3]).distance;
      vertices_[i][k] = vertex_part(corner).distance;
      scale_ = std::max({scale_, vertices_[i][k], std::fabs(Real(corner.x)),
                         std::fabs(Real(corner.y)), std::fabs(Real(corner.z))});
      auto& around = at_[Key(corner.x, corner.y, corner.z)];
      if (around.empty() || around.back() != i) around.push_back(i);
    }
  }
}

bool ContactOracle::is_earlier(std::size_t a, std::size_t b) const {
  return parts_[a].distance != parts_[b].distance ? parts_[a].distance < parts_[b].distance : a < b;
}

// Triangles that paths lead to which are farther than the triangle `from` by at most a margin.
std::vector<std::size_t> ContactOracle::reached(std::size_t from, Real margin) const {
  const Real level = parts_[from].distance + margin * scale_;
  std::vector<std::size_t> found{from};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Corners& corners = triangles_[found[i]];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
      for (const std::size_t other : at_.at(Key(a.x, a.y, a.z))) {
        const bool has_all = has(triangles_[other], corners[0]) &&
                             has(triangles_[other], corners[1]) &&
                             has(triangles_[other], corners[2]);
        const bool is_joined = vertices_[found[i]][k] <= level || has_all ||
                               (edges_[found[i]][k] <= level && has(triangles_[other], b));
        if (is_joined && std::find(found.begin(), found.end(), other) == found.end())
          found.push_back(other);
      }
    }
  }
  return found;
}

bool ContactOracle::touches(std::size_t from, std::size_t other, Real margin) const {
  const Corners& corners = triangles_[other];
  const Point& point = parts_[from].point;
  const Point on_other = nearest_on(point, {wide(corners[0]), wide(corners[1]), wide(corners[2])});
  return dot(on_other - point, on_other - point) <= margin * scale_ * margin * scale_;
}

// An earlier triangle that a path or a gap leads to; the triangle itself if there is none.
std::size_t ContactOracle::earlier_within(std::size_t from, Real margin) const {
  for (const std::size_t other : reached(from, margin))
    if (is_earlier(other, from)) return other;
  for (std::size_t other = 0; other < triangles_.size(); ++other)
    if (is_earlier(other, from) && touches(from, other, margin)) return other;
  return from;
}

std::size_t ContactOracle::root(std::size_t from) const {
  for (;;) {
    const std::size_t next = earlier_within(from, kNothing);
    if (next == from) return from;
    from = next;
  }
}

bool ContactOracle::is_certain(std::size_t triangle) const {
  return earlier_within(triangle, kCertain) == triangle;
}

std::size_t ContactOracle::certain_count(double radius) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    count += parts_[i].distance <= radius && is_certain(i);
  return count;
}

std::string ContactOracle::fault(std::span<const ClosestPoint> found, double radius,
                                 bool is_complete) const {
  std::ostringstream text;
  const Real margin = kCertain * scale_;
  std::vector<std::size_t> roots;
  for (const ClosestPoint& contact : found) {
    const std::size_t own = contact.triangle;
    if (own >= triangles_.size()) return "no such triangle";
    if (!roots.empty() && contact.distance < found[roots.size() - 1].distance) text << "order; ";
    if (contact.distance > radius) text << "beyond the radius; ";
    const std::size_t root = this->root(own);
    if (parts_[own].distance - parts_[root].distance > margin)
      text << own << " is no minimum: it leads to " << root << "; ";
    if (std::find(roots.begin(), roots.end(), root) != roots.end())
      text << own << " is a ghost of " << root << "; ";
    roots.push_back(root);
  }
  // What is not complete must hold the nearest ones.
  const Real within = is_complete     ? Real(radius)
                      : found.empty() ? Real(-1)
                                      : Real(found.back().distance);
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (parts_[i].distance > within - margin || !is_certain(i)) continue;
    const auto around = reached(i, kCertain);
    const bool is_found = std::any_of(found.begin(), found.end(), [&](const ClosestPoint& contact) {
      return std::find(around.begin(), around.end(), contact.triangle) != around.end() ||
             touches(i, contact.triangle, kCertain);
    });
    if (!is_found) text << i << " is missing; ";
  }
  return text.str();
}

}  // namespace planetree::oracle
