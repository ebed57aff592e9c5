#include "octree/mask/cap_rim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <new>
#include <utility>

#include "octree/geometry/strict_math.h"
#include "octree/traversal/tree_walk.h"

namespace planetree::octree {
namespace {

constexpr double kOverFourPi = 0x1.45f306dc9c883p-4;
/// Covers the rounding of the bound.
constexpr double kInflation = 1 + 0x1p-30;

}  // namespace

void CapRim::read(const TreeInfo& caps, const PageReader& pages) noexcept {
  try {
    TraversalStats work;
    std::vector<Triangle> found;
    const auto take = [&](const BlockView& block, std::uint32_t) {
      for (unsigned i = 0; i < block.triangle_count(); ++i) found.push_back(block.triangle(i));
    };
    const bool whole =
        BoxWalk(caps, caps.box_lower, caps.box_upper, pages, work).run_while(kMaxCaps, take, [&] {
          return found.size() <= kMaxCaps;
        });
    if (!whole || found.size() > kMaxCaps) return;
    find_edges(found);
    for (const Triangle& cap : found) caps_.push_back({least_corner(cap), greatest_corner(cap)});
  } catch (const std::bad_alloc&) {
    caps_.clear();
  }
}

void CapRim::find_edges(const std::vector<Triangle>& caps) {
  using Ends = std::pair<std::array<double, 3>, std::array<double, 3>>;
  std::map<Ends, std::int64_t> net;
  for (const Triangle& cap : caps)
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &a = cap[k], &b = cap[(k + 1) % 3];
      const std::array<double, 3> from{a.x(), a.y(), a.z()}, to{b.x(), b.y(), b.z()};
      if (from < to)
        ++net[{from, to}];
      else if (to < from)
        --net[{to, from}];
    }
  for (const auto& [ends, count] : net) {
    if (count == 0) continue;
    const Point a(ends.first[0], ends.first[1], ends.first[2]);
    const Point b(ends.second[0], ends.second[1], ends.second[2]);
    edges_.push_back(
        {{a.cwiseMin(b), a.cwiseMax(b)}, (b - a).norm() * std::fabs(static_cast<double>(count))});
  }
}

double CapRim::variation(const Point& lower, const Point& upper) const {
  double gradient = 0;
  for (const Edge& edge : edges_) gradient += edge.weight / edge.box.gap2(lower, upper);
  return kOverFourPi * gradient * (0.5 * (upper - lower).norm()) * kInflation;
}

}  // namespace planetree::octree
