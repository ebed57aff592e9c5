// Lower bounds on the distances from a query to a node's children, and the children's order.

#if defined(PLANETREE_OCTREE_NODE_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_NODE_KERNELS_INL_H_
#undef PLANETREE_OCTREE_NODE_KERNELS_INL_H_
#else
#define PLANETREE_OCTREE_NODE_KERNELS_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "octree/geometry/wide_floats-inl.h"
#include "octree/page/frame_lanes-inl.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/frontier.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Returns squared lower bounds of a node's children from `i` on; see octree/traversal/bounds.h.
HWY_INLINE Floats child_bounds(const Node& node, const Wide3& p, bool discs, std::size_t i) {
  const FloatTag d;
  const Wide3 lower{lower_sides(node, 0, i), lower_sides(node, 1, i), lower_sides(node, 2, i)};
  const Wide3 upper{upper_sides(node, 0, i), upper_sides(node, 1, i), upper_sides(node, 2, i)};
  const Wide3 gap{outside(lower.x, upper.x, p.x), outside(lower.y, upper.y, p.y),
                  outside(lower.z, upper.z, p.z)};
  const Floats bound = hn::Min(dot(gap, gap), hn::Set(d, kMaxFloatBound));
  if (!discs) return bound;
  const Floats half = hn::Set(d, 0.5f);
  const Floats zero = hn::Zero(d);
  const Wide3 centre{hn::Mul(hn::Add(lower.x, upper.x), half),
                     hn::Mul(hn::Add(lower.y, upper.y), half),
                     hn::Mul(hn::Add(lower.z, upper.z), half)};
  const Wide3 normal{hn::Load(d, node.normal[0] + i), hn::Load(d, node.normal[1] + i),
                     hn::Load(d, node.normal[2] + i)};
  const Wide3 from = sub(p, centre);
  const Floats height = dot(normal, from);
  const Floats slab_gap =
      outside(hn::Load(d, node.slab_lower + i), hn::Load(d, node.slab_upper + i), height);
  const Floats kept = hn::Mul(dot(from, from), hn::Set(d, 1.0f - kDiscCancellation));
  const Floats axis_distance = hn::Sqrt(hn::Max(hn::Sub(kept, hn::Mul(height, height)), zero));
  const Floats radius_gap = hn::Max(hn::Sub(axis_distance, hn::Load(d, node.radius + i)), zero);
  return hn::Max(bound, hn::Add(hn::Mul(slab_gap, slab_gap), hn::Mul(radius_gap, radius_gap)));
}

// Returns a bit for each of a node's children whose box meets `box`.
HWY_INLINE unsigned meeting_children(const Node& node, const FloatBox& box) {
  const FloatTag d;
  unsigned found = 0;
  for (std::size_t i = 0; i < kFanOut; i += hn::Lanes(d)) {
    auto apart = hn::FirstN(d, 0);
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      apart = hn::Or(apart, hn::Gt(lower_sides(node, axis, i), hn::Set(d, box.upper[axis])));
      apart = hn::Or(apart, hn::Lt(upper_sides(node, axis, i), hn::Set(d, box.lower[axis])));
    }
    found |= mask_bits(d, hn::Not(apart)) << i;
  }
  return found & ((1U << node.child_count) - 1);
}

// Replaces the low bits of squared bounds, `number_bits`, by numbers that count up from `first`.
// The keys have the same order on all targets: bounds are not negative, so that their bits are
// ordered as they are. `first` is a multiple of the number of lanes.
template <class Lanes>
HWY_INLINE auto bound_keys(Lanes bounds, std::int32_t number_bits, std::size_t first) {
  const hn::RebindToSigned<hn::DFromV<Lanes>> d;
  return hn::Or(hn::AndNot(hn::Set(d, number_bits), hn::BitCast(d, bounds)),
                hn::Iota(d, static_cast<std::int32_t>(first)));
}
inline constexpr std::int32_t kNoKey = std::numeric_limits<std::int32_t>::max();

// Bits of a bound that are replaced by the child's number.
inline constexpr std::int32_t kChildBits = kFanOut - 1;

// Returns keys of children from `i` on: a bound and the child's number.
HWY_INLINE Ints child_keys(const Node& node, const Wide3& p, bool discs, std::size_t i) {
  return bound_keys(child_bounds(node, p, discs, i), kChildBits, i);
}

#if PLANETREE_EIGHT_LANES
// Sorts eight integers within a register by a bitonic network.
HWY_INLINE Ints sort_lanes(Ints v) {
  const IntTag d;
  const hn::Repartition<std::int64_t, IntTag> pairs;
  const auto odd_even_pairs = [&](Ints odd, Ints even) {
    return hn::BitCast(d, hn::OddEven(hn::BitCast(pairs, odd), hn::BitCast(pairs, even)));
  };
  const auto next_to = [&](Ints at) {
    const Ints other = hn::Reverse2(d, at);
    return hn::OddEven(hn::Max(at, other), hn::Min(at, other));
  };
  v = next_to(v);
  Ints other = hn::Reverse4(d, v);
  v = next_to(odd_even_pairs(hn::Max(v, other), hn::Min(v, other)));
  other = hn::Reverse8(d, v);
  v = hn::ConcatUpperLower(d, hn::Max(v, other), hn::Min(v, other));
  other = hn::Shuffle1032(v);
  return next_to(odd_even_pairs(hn::Max(v, other), hn::Min(v, other)));
}
#endif

// How many children of a node are within a threshold, and the nearest child.
struct NearChildren {
  unsigned count;
  std::int32_t nearest;  // child_keys() of the nearest child

  // Bound and number of the nearest child; only if count > 0.
  float bound() const { return std::bit_cast<float>(nearest & ~kChildBits); }
  unsigned child() const { return static_cast<unsigned>(nearest & kChildBits); }
};

// Writes all children of a node to `group`, nearest first, and counts those whose bounds are not
// above `threshold`. The low bits kChildBits of bounds are cleared.
//
// allowed  a bit for each child that may count; the others come last. Null: all.
HWY_INLINE NearChildren sorted_children(const Node& node, const FloatQuery& query, bool discs,
                                        float threshold, FrontierGroup& group,
                                        const unsigned* allowed = nullptr) {
  const FloatTag d;
  const IntTag di;
  const Wide3 p{hn::Set(d, query.x), hn::Set(d, query.y), hn::Set(d, query.z)};
  const std::int32_t max_key = std::bit_cast<std::int32_t>(threshold) | kChildBits;
#if PLANETREE_EIGHT_LANES
  const hn::RebindToUnsigned<IntTag> du;
  auto used = hn::Lt(hn::Iota(di, 0), hn::Set(di, node.child_count));
  if (allowed) {
    HWY_ALIGN static constexpr std::int32_t kBits[kFanOut] = {1, 2, 4, 8, 16, 32, 64, 128};
    const Ints bits = hn::Set(di, static_cast<std::int32_t>(*allowed));
    used = hn::And(used, hn::TestBit(bits, hn::Load(di, kBits)));
  }
  const Ints unsorted = hn::IfThenElse(used, child_keys(node, p, discs, 0), hn::Set(di, kNoKey));
  // Computed separately, so that the traversal can go on without waiting for the sorted order.
  const std::int32_t nearest = hn::GetLane(hn::MinOfLanes(di, unsorted));
  const Ints keys = sort_lanes(unsorted);
  const auto child = hn::IndicesFromVec(du, hn::And(keys, hn::Set(di, kChildBits)));
  hn::Store(hn::AndNot(hn::Set(di, kChildBits), keys), di, group.bound_bits);
  hn::Store(hn::TableLookupLanes(hn::Load(du, node.link), child), du, group.link);
  const auto near = hn::Not(hn::Gt(unsorted, hn::Set(di, max_key)));
  return {static_cast<unsigned>(hn::CountTrue(di, near)), nearest};
#else
  HWY_ALIGN std::int32_t keys[kFanOut];
  for (std::size_t i = 0; i < kFanOut; i += hn::Lanes(d))
    hn::Store(child_keys(node, p, discs, i), di, keys + i);
  if (allowed)
    for (unsigned i = 0; i < kFanOut; ++i)
      if ((*allowed >> i & 1) == 0) keys[i] = kNoKey;
  // Tells the compiler that there are at most kFanOut children.
  std::sort(keys, keys + std::min<std::size_t>(node.child_count, kFanOut));
  unsigned count = 0;
  for (unsigned i = 0; i < node.child_count; ++i) {
    group.bound_bits[i] = keys[i] & ~kChildBits;
    group.link[i] = node.link[keys[i] & kChildBits];
    count += keys[i] <= max_key ? 1 : 0;
  }
  return {count, node.child_count > 0 ? keys[0] : kNoKey};
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
