#include "octree/mask/cap_rim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>
#include <span>

#include "octree/geometry/strict_math.h"
#include "octree/traversal/tree_walk.h"

namespace planetree::octree {
namespace {

constexpr double kOverFourPi = 0x1.45f306dc9c883p-4;
/// Covers the rounding of the bound.
constexpr double kInflation = 1 + 0x1p-30;

}  // namespace

struct CapRim::Space {
  // Of its ends the lesser comes first.
  struct HalfEdge {
    std::array<double, 6> ends;
    int way;  // 1: from the lesser end to the greater; -1: back
  };
  static constexpr std::size_t kMaxEdges = 3 * kMaxCaps;

  std::array<Triangle, kMaxCaps> found;
  std::array<HalfEdge, kMaxEdges> halves;
  std::array<Box, kMaxCaps> caps;
  std::array<Edge, kMaxEdges> edges;
  std::size_t found_count;
};

void CapRim::Free::operator()(Space* space) const noexcept { delete space; }

void CapRim::read(const TreeInfo& caps, const PageReader& pages) noexcept {
  space_.reset(new (std::nothrow) Space);  // written where it is used
  if (!space_) return;
  TraversalStats work;
  std::size_t& count = space_->found_count = 0;
  bool fits = true;
  const auto take = [&](const BlockView& block, std::uint32_t) {
    fits = fits && count + block.triangle_count() <= kMaxCaps;
    for (unsigned i = 0; fits && i < block.triangle_count(); ++i)
      space_->found[count++] = block.triangle(i);
  };
  const bool whole =
      BoxWalk(caps, caps.box_lower, caps.box_upper, pages, work).run_while(kMaxCaps, take, [&] {
        return fits;
      });
  if (!whole || !fits) return;
  find_edges();
  for (std::size_t i = 0; i < count; ++i)
    space_->caps[i] = {least_corner(space_->found[i]), greatest_corner(space_->found[i])};
  caps_ = std::span(space_->caps).first(count);
}

void CapRim::find_edges() {
  std::size_t count = 0;
  for (const Triangle& cap : std::span(space_->found).first(space_->found_count))
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &a = cap[k], &b = cap[(k + 1) % 3];
      if (a == b) continue;
      const bool forward = std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
      const Point &from = forward ? a : b, &to = forward ? b : a;
      space_->halves[count++] = {{from.x(), from.y(), from.z(), to.x(), to.y(), to.z()},
                                 forward ? 1 : -1};
    }
  const auto halves = std::span(space_->halves).first(count);
  std::sort(halves.begin(), halves.end(),
            [](const auto& a, const auto& b) { return a.ends < b.ends; });
  count = 0;
  for (std::size_t i = 0; i < halves.size();) {
    const std::array<double, 6>& ends = halves[i].ends;
    std::int64_t net = 0;
    for (; i < halves.size() && halves[i].ends == ends; ++i) net += halves[i].way;
    if (net == 0) continue;
    const Point a(ends[0], ends[1], ends[2]), b(ends[3], ends[4], ends[5]);
    space_->edges[count++] = {{a.cwiseMin(b), a.cwiseMax(b)},
                              (b - a).norm() * std::fabs(static_cast<double>(net))};
  }
  edges_ = std::span(space_->edges).first(count);
}

double CapRim::variation(const Point& lower, const Point& upper) const {
  double gradient = 0;
  for (const Edge& edge : edges_) gradient += edge.weight / edge.box.gap2(lower, upper);
  return kOverFourPi * gradient * (0.5 * (upper - lower).norm()) * kInflation;
}

}  // namespace planetree::octree
