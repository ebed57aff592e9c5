#include "query/shell/sphere_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "query/shell/vectors.h"

namespace planetree::query {
namespace {

using Point = SphereTree::Point;

struct Box {
  Vec3 lower, upper;

  explicit Box(std::span<const Point> points) : lower(points[0].position), upper(lower) {
    for (const Point& point : points) {
      const Vec3& p = point.position;
      lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
      upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
    }
  }
  Vec3 centre() const {
    return {0.5 * lower.x + 0.5 * upper.x, 0.5 * lower.y + 0.5 * upper.y,
            0.5 * lower.z + 0.5 * upper.z};
  }
  double Vec3::*longest_axis() const {
    const Vec3 size = upper - lower;
    if (size.x >= size.y && size.x >= size.z) return &Vec3::x;
    return size.y >= size.z ? &Vec3::y : &Vec3::z;
  }
};

// Divides points into two halves along the longest axis of their box. Returns the size of the
// first.
std::size_t halve(std::span<Point> points) {
  const auto axis = Box(points).longest_axis();
  const std::size_t half = points.size() / 2;
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(half), points.end(),
                   [axis](const Point& a, const Point& b) {
                     const double of_a = a.position.*axis, of_b = b.position.*axis;
                     return of_a != of_b ? of_a < of_b : a.number < b.number;
                   });
  return half;
}

struct Farthest {
  Vec3 position;
  double distance = 0;  // rounded up
};

Farthest farthest_from(const Vec3& centre, std::span<const Point> points) {
  Farthest farthest;
  for (const Point& point : points) {
    const double distance = upper_length(point.position - centre);
    if (distance > farthest.distance) farthest = {point.position, distance};
  }
  return farthest;
}

}  // namespace

SphereTree::SphereTree(std::span<const ShellPoint> points) {
  points_.reserve(points.size());
  double off_unit = 0;
  for (const ShellPoint& point : points) {
    const double length2 = dot(point.normal, point.normal);
    off_unit = std::max(off_unit, std::fabs(length2 - 1));
    points_.push_back({point.position, point.normal * (1 / std::sqrt(length2)),
                       static_cast<std::uint32_t>(points_.size())});
  }
  // A length differs from 1 by less than its square does.
  normal_error_ = off_unit + octree::kNormRounding;
  Node root;
  root.count = static_cast<std::uint32_t>(points_.size());
  bound(root);
  nodes_.push_back(root);
  for (std::size_t node = 0; node < nodes_.size(); ++node) divide(node);
  for (const Point& point : points_) reach_ = std::max(reach_, upper_length(point.position));
  for (const Node& node : nodes_) {
    reach_ = std::max(reach_, upper_length(node.centre));
    if (node.children == 0) leaf_radius_ = std::max(leaf_radius_, node.radius);
  }
}

// Begins with the centre of the box and goes towards the farthest point by ever smaller steps
// (Badoiu & Clarkson 2003), which comes near the smallest sphere.
void SphereTree::bound(Node& node) const {
  constexpr int kSteps = 16;
  const std::span<const Point> inside = std::span(points_).subspan(node.first, node.count);
  Vec3 centre = Box(inside).centre();
  node.radius = std::numeric_limits<double>::infinity();
  for (int step = 0; step <= kSteps; ++step) {
    const auto [farthest, radius] = farthest_from(centre, inside);
    if (radius < node.radius) {
      node.centre = centre;
      node.radius = radius;
    }
    centre = centre + (farthest - centre) * (1.0 / (step + 2));
  }
}

void SphereTree::divide(std::size_t node) {
  const Node parent = nodes_[node];
  if (parent.count <= kMaxLeafPoints) return;
  const std::span<Point> all = std::span(points_).subspan(parent.first, parent.count);
  const std::size_t middle = halve(all);
  const std::size_t low = halve(all.first(middle)), high = halve(all.subspan(middle));
  const std::array<std::size_t, kMaxChildren + 1> ends{0, low, middle, middle + high, all.size()};
  nodes_[node].first_child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].children = kMaxChildren;
  for (std::size_t i = 0; i < kMaxChildren; ++i) {
    Node child;
    child.first = parent.first + static_cast<std::uint32_t>(ends[i]);
    child.count = static_cast<std::uint32_t>(ends[i + 1] - ends[i]);
    bound(child);
    nodes_.push_back(child);
  }
}

}  // namespace planetree::query
