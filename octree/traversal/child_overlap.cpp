#include "octree/traversal/child_overlap.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/traversal/child_overlap.cpp"
#include <hwy/foreach_target.h>

#include <cassert>

#include "octree/geometry/packed_lanes-inl.h"
#include "octree/geometry/strict_math.h"
#include "octree/traversal/node_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

unsigned meeting_on_target(const Node& node, const FloatBox& box) {
  return meeting_children(node, box);
}

std::uint64_t subtrees_on_target(const NearbySubtrees& list, const FloatBox& box) {
  const TriangleTag d;
  std::uint64_t found = 0;
  for (std::size_t i = 0; i < list.size(); i += hn::Lanes(d)) {
    auto apart = hn::FirstN(d, 0);
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      apart = hn::Or(apart, hn::Gt(hn::Load(d, list.lower(axis) + i), hn::Set(d, box.upper[axis])));
      apart = hn::Or(apart, hn::Lt(hn::Load(d, list.upper(axis) + i), hn::Set(d, box.lower[axis])));
    }
    found |= std::uint64_t{mask_bits(d, hn::Not(apart))} << i;
  }
  return list.size() < NearbySubtrees::kMax ? found & ((std::uint64_t{1} << list.size()) - 1)
                                            : found;
}

void add_within_on_target(const Node& node, const FloatQuery& query, float threshold,
                          NearbySubtrees& list) {
  const FloatTag d;
  const hn::RebindToUnsigned<FloatTag> du;
  const Wide3 p{hn::Set(d, query.x), hn::Set(d, query.y), hn::Set(d, query.z)};
  for (std::size_t i = 0; i < node.child_count; i += hn::Lanes(d)) {
    const auto beyond = hn::Gt(child_bounds(node, p, false, i), hn::Set(d, threshold));
    const PackedLanes near(d, hn::AndNot(beyond, hn::FirstN(d, node.child_count - i)));
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      near.store(lower_sides(node, axis, i), list.next_lower(axis));
      near.store(upper_sides(node, axis, i), list.next_upper(axis));
    }
    near.store(hn::Load(du, node.link + i), list.next_link());
    list.add(near.count());
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(meeting_on_target);
HWY_EXPORT(subtrees_on_target);
HWY_EXPORT(add_within_on_target);

unsigned children_meeting(const Node& node, const FloatBox& box) noexcept {
  return HWY_DYNAMIC_DISPATCH(meeting_on_target)(node, box);
}

std::uint64_t subtrees_meeting(const NearbySubtrees& list, const FloatBox& box) noexcept {
  return HWY_DYNAMIC_DISPATCH(subtrees_on_target)(list, box);
}

void add_children_within(const Node& node, const FloatQuery& query, float threshold,
                         NearbySubtrees& list) noexcept {
  assert(list.has_capacity());
  HWY_DYNAMIC_DISPATCH(add_within_on_target)(node, query, threshold, list);
}

}  // namespace planetree::octree
#endif
