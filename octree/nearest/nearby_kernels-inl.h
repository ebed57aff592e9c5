// Kernels that find the nearest of the subtrees and triangles that a coherence cache holds.

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

#include "octree/geometry/triangle_kernels-inl.h"
#include "octree/geometry/wide_floats-inl.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/best_triangle.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/nearby_lists.h"
#include "octree/traversal/node_kernels-inl.h"
#include "octree/traversal/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Subtrees of a list with their squared bounds, nearest first. Squared bounds are not negative, so
// that their bits are in the same order as their values. The last bits of each bound are replaced
// by the subtree's index in the list.
class SubtreeKeys {
 public:
  static constexpr std::int32_t kIndexBits = NearbySubtrees::kMax - 1;

  std::size_t size() const { return size_; }
  std::size_t index(std::size_t i) const { return static_cast<std::size_t>(at_[i] & kIndexBits); }
  float bound(std::size_t i) const { return std::bit_cast<float>(at_[i] & ~kIndexBits); }

  // Adds the keys of the lanes that `near` selects.
  template <class Near, class Keys>
  HWY_INLINE void add(const Near& near, Keys keys) {
    near.store(keys, at_ + size_);
    size_ += near.count();
  }

  HWY_INLINE void sort() {
#if PLANETREE_EIGHT_LANES
    if (size_ <= kFanOut) {
      const IntTag d;
      const auto used = hn::FirstN(d, size_);
      const Ints keys = hn::IfThenElse(used, hn::Load(d, at_), hn::Set(d, kNoKey));
      return hn::Store(sort_lanes(keys), d, at_);
    }
#endif
    std::sort(at_, at_ + size_);
  }

 private:
  std::size_t size_ = 0;
  // PackedLanes::store() writes a whole vector, which may reach beyond the last key.
  HWY_ALIGN std::int32_t at_[NearbySubtrees::kMax + kMaxBlockTriangles];
};

// Finds the subtrees whose squared box bound is not above `threshold`, nearest first.
HWY_INLINE void find_near(const NearbySubtrees& list, const FloatQuery& query, float threshold,
                          SubtreeKeys& found) {
  const TriangleTag d;
  const TriangleVectors p{hn::Set(d, query.x), hn::Set(d, query.y), hn::Set(d, query.z)};
  for (std::size_t i = 0; i < list.size(); i += hn::Lanes(d)) {
    const auto gap = [&](std::size_t axis, TriangleFloats at) {
      return outside(hn::Load(d, list.lower(axis) + i), hn::Load(d, list.upper(axis) + i), at);
    };
    const TriangleVectors gaps{gap(0, p.x), gap(1, p.y), gap(2, p.z)};
    const TriangleFloats squared = hn::Min(dot(gaps, gaps), hn::Set(d, kMaxFloatBound));
    const auto beyond = hn::Gt(squared, hn::Set(d, threshold));
    const PackedLanes near(d, hn::AndNot(beyond, hn::FirstN(d, list.size() - i)));
    found.add(near, bound_keys(squared, SubtreeKeys::kIndexBits, i));
  }
  found.sort();
}

// Evaluates four triangles of a list, from `first` on, and offers those that have a bit in `near`.
HWY_INLINE void offer_four(const NearbyTriangles& list, std::size_t first, unsigned near,
                           const Point& query, WorkLimit& limit, BestTriangle& best) {
  TriangleResults results;
  near &= ~evaluate_selected(list.exact().view(first), near, query, limit, results);
  for (; near != 0; near &= near - 1) {
    const auto lane = static_cast<unsigned>(std::countr_zero(near));
    best.offer(results.of(lane), list.id(first + lane), list.is_height_field(first + lane),
               [&](Triangle& to) { list.exact().view(0).copy_triangle(first + lane, to); });
  }
}

// Offers the triangles of a list that may be nearest. Triangles farther than `reach` from the
// list's centre cannot matter. Even a query without work gets those that double suffices for, which
// take a bounded time; limit.exceeded() tells whether others were left out.
HWY_INLINE void offer_nearby(const NearbyTriangles& list, double reach, const Point& query,
                             const FloatQuery& float_query, BestTriangle& best,
                             WorkLimit& work_limit, TraversalStats& work) {
  const TriangleTag d;
  const std::size_t count = list.count_within(reach);
  const FloatOffset from(query, list.centre());
  const NearbyTriangleLanes triangles(list, from.at);
  HWY_ALIGN float squared[NearbyTriangles::kMax];  // lower bounds
  const TriangleFloats none = hn::Set(d, std::numeric_limits<float>::infinity());
  TriangleFloats least = none;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const TriangleBounds bounds =
        triangle_bounds(triangles.corner(0, i), triangles.corner(1, i), triangles.corner(2, i));
    hn::Store(bounds.lower, d, squared + i);
    const auto listed = hn::FirstN(d, count - i);
    least = hn::Min(least, hn::IfThenElse(listed, bounds.upper, none));
  }
  const float min_upper = hn::GetLane(hn::MinOfLanes(d, least));
  const double upper = std::min(best.reach(), filter_upper(min_upper, list.extent()));
  const float limit = filter_threshold(float_query, upper, list.extent());
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    unsigned near = bits_not_above(hn::Load(d, squared + i), limit);
    if (count - i < hn::Lanes(d)) near &= (1u << (count - i)) - 1;
    for (std::size_t first = i; near != 0; first += kTrianglesAtOnce, near >>= kTrianglesAtOnce) {
      const unsigned four = near & ((1u << kTrianglesAtOnce) - 1);
      if (four == 0) continue;
      work.triangles += static_cast<unsigned>(std::popcount(four));
      offer_four(list, first, four, query, work_limit, best);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
