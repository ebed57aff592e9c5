#include "tests/golden/spec_tree.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "tests/golden/spec_vector.h"

namespace planetree::golden {
namespace {

double distance_to_segment(const SpecPoint& p, const SpecPoint& a, const SpecPoint& b) {
  const SpecPoint ab = b - a, ap = p - a;
  const double square = dot(ab, ab);
  const double t = square > 0 ? std::clamp(dot(ap, ab) / square, 0.0, 1.0) : 0.0;
  const SpecPoint gap = {ap[0] - t * ab[0], ap[1] - t * ab[1], ap[2] - t * ab[2]};
  return std::sqrt(dot(gap, gap));
}

double distance_to_triangle(const SpecPoint& p, const SpecTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  const double to_edges = std::min(
      {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
  const SpecPoint normal = cross(b - a, c - a);
  const bool above = dot(cross(b - a, p - a), normal) > 0 && dot(cross(c - b, p - b), normal) > 0 &&
                     dot(cross(a - c, p - c), normal) > 0;
  if (!above) return to_edges;
  return std::min(to_edges, std::fabs(dot(p - a, normal)) / std::sqrt(dot(normal, normal)));
}

// q is relative to the centre.
double box_bound(const SpecBox& box, const SpecPoint& q) {
  SpecPoint gap{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lower = box.lower[axis], upper = box.upper[axis];
    gap[axis] = std::max({0.0, lower - q[axis], q[axis] - upper});
  }
  return std::sqrt(dot(gap, gap)) * (1 - 0x1p-50);
}

double disc_bound(const SpecDisc& disc, const SpecPoint& q) {
  const SpecPoint middle = {disc.middle[0], disc.middle[1], disc.middle[2]};
  const SpecPoint normal = {disc.normal[0], disc.normal[1], disc.normal[2]};
  const SpecPoint e = q - middle;
  const double h = dot(normal, e);
  const double s = std::max(
      {0.0, static_cast<double>(disc.slab_lower) - h, h - static_cast<double>(disc.slab_upper)});
  const double from_axis = std::sqrt(std::max(0.0, (1 - 0x1p-19) * dot(e, e) - h * h));
  const double t = std::max(0.0, from_axis - static_cast<double>(disc.radius));
  return std::sqrt(s * s + t * t) * (1 - 0x1p-20);
}

}  // namespace

SpecTree::SpecTree(const SpecFile& file, Of of)
    : header_(file.header()), of_caps_(of == Of::kCaps) {
  const std::uint32_t end = of_caps_ ? header_.e() : header_.c();
  for (std::uint32_t k = of_caps_ ? header_.c() : 0; k < end; ++k) pages_.push_back(file.page(k));
}

SpecCounts SpecTree::counts() const {
  if (!of_caps_)
    return {header_.triangle_count, header_.node_count, header_.block_count, header_.height};
  return {header_.cap_count, header_.cap_node_count, header_.cap_block_count, header_.cap_height};
}

std::uint32_t SpecTree::page_of(SpecLink link) const {
  return page_of_link(link) - (of_caps_ ? header_.c() : 0);
}

const SpecNode& SpecTree::node(SpecLink link) const {
  return pages_.at(page_of(link)).nodes.at(link);
}

const SpecBlock& SpecTree::block(SpecLink link) const {
  return pages_.at(page_of(link)).blocks.at(link);
}

std::vector<SpecTriangle> SpecTree::triangles(SpecLink link) const {
  std::vector<SpecTriangle> found;
  collect(link, found);
  return found;
}

void SpecTree::collect(SpecLink link, std::vector<SpecTriangle>& found) const {
  if (is_block(link)) {
    const std::vector<SpecTriangle>& here = block(link).triangles;
    found.insert(found.end(), here.begin(), here.end());
    return;
  }
  for (const SpecChild& child : node(link).children) collect(child.link, found);
}

double SpecTree::child_bound(const SpecChild& child, const SpecPoint& from_centre) const {
  const double farthest =
      std::max({std::fabs(from_centre[0]), std::fabs(from_centre[1]), std::fabs(from_centre[2])});
  return std::max(box_bound(child.box, from_centre), disc_bound(child.disc, from_centre)) -
         0x1p-50 * (1 + farthest);
}

SpecNearest SpecTree::nearest(const SpecPoint& point) const {
  using Entry = std::pair<double, SpecLink>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> heap;
  SpecNearest best{~std::uint64_t{0}, std::numeric_limits<double>::infinity()};
  heap.emplace(0.0, root_link());
  while (!heap.empty()) {
    const auto [bound, link] = heap.top();
    heap.pop();
    if (bound > best.distance) break;
    if (!is_block(link)) {
      for (const SpecChild& child : node(link).children)
        heap.emplace(child_bound(child, point - header_.centre), child.link);
      continue;
    }
    for (const SpecTriangle& triangle : block(link).triangles) {
      const double distance = distance_to_triangle(point, triangle);
      if (distance < best.distance || (distance == best.distance && triangle.id < best.triangle))
        best = {triangle.id, distance};
    }
  }
  return best;
}

}  // namespace planetree::golden
