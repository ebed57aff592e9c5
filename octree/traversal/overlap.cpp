#include "octree/traversal/overlap.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/traversal/overlap.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <bit>
#include <cassert>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/wide_floats-inl.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/node_kernels-inl.h"
#include "octree/traversal/triangle_filter-inl.h"

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

unsigned triangles_on_target(const BlockView& block, const Point& point, float limit,
                             double (&nearest)[kMaxBlockTriangles]) {
  const BlockHeader& header = block.header();
  FilteredTriangles filtered;
  filter_block(header, FloatOffset(point, block.vertex(0)).at, limit, filtered);
  for (unsigned near = filtered.near; near != 0; near &= near - 1) {
    const auto i = static_cast<unsigned>(std::countr_zero(near));
    nearest[i] = filter_lower(filtered.squared[i], header.extent);
  }
  return filtered.near;
}

NearbyTriangleBits corners_on_target(const NearbyTriangles& list, float x) {
  const TriangleTag d;
  const auto at = hn::Set(d, x);
  NearbyTriangleBits found{};
  for (std::size_t i = 0; i < list.size(); i += hn::Lanes(d)) {
    auto same = hn::Eq(hn::Load(d, list.row(0, 0) + i), at);
    for (std::size_t corner = 1; corner < 3; ++corner)
      same = hn::Or(same, hn::Eq(hn::Load(d, list.row(corner, 0) + i), at));
    std::uint64_t bits = mask_bits(d, same);
    if (list.size() - i < hn::Lanes(d)) bits &= (std::uint64_t{1} << (list.size() - i)) - 1;
    found[i / 64] |= bits << i % 64;
  }
  return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(meeting_on_target);
HWY_EXPORT(subtrees_on_target);
HWY_EXPORT(add_within_on_target);
HWY_EXPORT(triangles_on_target);
HWY_EXPORT(corners_on_target);

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

unsigned triangles_within(const BlockView& block, const Point& point, const FloatQuery& wide,
                          double distance, double (&nearest)[kMaxBlockTriangles]) noexcept {
  // The block is too small for float, or the query too far away.
  if (!can_filter(wide, block.header().extent)) {
    std::fill_n(nearest, block.triangle_count(), 0.0);
    return (1U << block.triangle_count()) - 1;
  }
  const float limit = filter_threshold(wide, distance, block.header().extent);
  return HWY_DYNAMIC_DISPATCH(triangles_on_target)(block, point, limit, nearest);
}

NearbyTriangleBits triangles_with_corner(const NearbyTriangles& list,
                                         const Point& corner) noexcept {
  // Rounded as in the list.
  const auto x = static_cast<float>(corner.x() - list.centre().x());
  return HWY_DYNAMIC_DISPATCH(corners_on_target)(list, x);
}

}  // namespace planetree::octree
#endif
