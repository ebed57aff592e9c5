// The nearest of the subtrees and triangles that a ball holds.

#if defined(PLANETREE_OCTREE_NEARBY_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_NEARBY_KERNELS_INL_H_
#undef PLANETREE_OCTREE_NEARBY_KERNELS_INL_H_
#else
#define PLANETREE_OCTREE_NEARBY_KERNELS_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "octree/best_triangle.h"
#include "octree/bounds.h"
#include "octree/nearby_subtrees.h"
#include "octree/nearby_triangles.h"
#include "octree/triangle_filter-inl.h"
#include "octree/triangle_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Subtrees of a list with bounds of theirs. Squared bounds are not negative, so that their bits
// order as they do.
struct SubtreeKeys {
  std::uint64_t at[NearbySubtrees::kMost];  // the bound's bits, then the place in the list

  std::size_t place(std::size_t i) const { return static_cast<std::uint32_t>(at[i]); }
  float bound(std::size_t i) const {
    return std::bit_cast<float>(static_cast<std::uint32_t>(at[i] >> 32));
  }
  // The place of the least of the first `count`, of which there are some.
  std::size_t least(std::size_t count) const {
    return static_cast<std::size_t>(std::min_element(at, at + count) - at);
  }
};

// Finds the subtrees whose boxes come as near as a threshold, and returns how many.
HWY_INLINE std::size_t near_subtrees(const NearbySubtrees& list, const FloatQuery& query,
                                     float threshold, SubtreeKeys& keys) {
  const TriangleTag d;
  const TriangleVectors p{hn::Set(d, query.x), hn::Set(d, query.y), hn::Set(d, query.z)};
  std::size_t count = 0;
  for (std::size_t i = 0; i < list.size(); i += hn::Lanes(d)) {
    const auto gap = [&](std::size_t axis, TriangleFloats at) {
      return outside(hn::Load(d, list.lower(axis) + i), hn::Load(d, list.upper(axis) + i), at);
    };
    const TriangleVectors gaps{gap(0, p.x), gap(1, p.y), gap(2, p.z)};
    const TriangleFloats squared = dot(gaps, gaps);
    HWY_ALIGN std::uint32_t bits[hn::MaxLanes(d)];
    hn::Store(hn::BitCast(hn::RebindToUnsigned<TriangleTag>(), squared),
              hn::RebindToUnsigned<TriangleTag>(), bits);
    unsigned near = bits_not_above(squared, threshold);
    if (list.size() - i < hn::Lanes(d)) near &= (1u << (list.size() - i)) - 1;
    for (; near != 0; near &= near - 1) {
      const auto lane = static_cast<unsigned>(std::countr_zero(near));
      keys.at[count++] = std::uint64_t{bits[lane]} << 32 | (i + lane);
    }
  }
  return count;
}

// Evaluates four of a list, and offers those of them that `near` has a bit for.
HWY_INLINE void offer_four(const NearbyTriangles& list, std::size_t first, unsigned near,
                           const Point& query, BestTriangle& best) {
  const TriangleView view = list.exact().view(first);
  TriangleFindings findings;
  if (const unsigned flat = evaluate_triangles(view.at, view.stride, query, findings) & near)
    refine_flat(query, view, flat, findings);
  for (; near != 0; near &= near - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(near));
    best.offer(findings.of(lane), list.id(first + lane), list.in_sheet(first + lane),
               [&] { return list.triangle(first + lane); });
  }
}

// Offers what may be nearest of a list. No triangle matters that is farther from the list's
// centre than `reach`.
HWY_INLINE void offer_nearby(const NearbyTriangles& list, double reach, const Point& query,
                             const FloatQuery& wide, BestTriangle& best, TreeWork& work) {
  const TriangleTag d;
  const std::size_t count = list.count_within(reach);
  const FloatOffset from(query, list.centre());
  const ListedTriangles triangles(list, from.at);
  HWY_ALIGN float squared[NearbyTriangles::kMost];  // lower bounds
  const TriangleFloats none = hn::Set(d, std::numeric_limits<float>::infinity());
  TriangleFloats least = none;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const TriangleBounds bounds =
        triangle_bounds(triangles.corner(0, i), triangles.corner(1, i), triangles.corner(2, i));
    hn::Store(bounds.lower, d, squared + i);
    const auto listed = hn::FirstN(d, count - i);
    least = hn::Min(least, hn::IfThenElse(listed, bounds.upper, none));
  }
  const float least_upper = hn::GetLane(hn::MinOfLanes(d, least));
  const double upper = std::min(best.reach(), filter_upper(least_upper, list.extent()));
  const float limit = filter_threshold(wide, upper, list.extent());
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    unsigned near = bits_not_above(hn::Load(d, squared + i), limit);
    if (count - i < hn::Lanes(d)) near &= (1u << (count - i)) - 1;
    for (std::size_t first = i; near != 0; first += kTrianglesAtOnce, near >>= kTrianglesAtOnce) {
      const unsigned four = near & ((1u << kTrianglesAtOnce) - 1);
      if (four == 0) continue;
      work.triangles += static_cast<unsigned>(std::popcount(four));
      offer_four(list, first, four, query, best);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
