// The two wide loops of a descent, compiled once for each instruction set that
// Highway knows at hand. Multiplications and additions are never fused and
// lanes never mixed, so that every set computes the same bits.

#if defined(PLANETREE_OCTREE_WIDE_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_WIDE_KERNELS_INL_H_
#undef PLANETREE_OCTREE_WIDE_KERNELS_INL_H_
#else
#define PLANETREE_OCTREE_WIDE_KERNELS_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include "octree/bounds.h"
#include "octree/frontier.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Whether one register holds eight floats, and has operations across all of them.
#undef PLANETREE_EIGHT_LANES
#define PLANETREE_EIGHT_LANES (HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2)

using FloatTag = hn::CappedTag<float, kFanOut>;
using IntTag = hn::RebindToSigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using Ints = hn::Vec<IntTag>;

struct Wide3 {
  Floats x, y, z;
};

HWY_INLINE Wide3 sub(const Wide3& a, const Wide3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

HWY_INLINE Floats dot(const Wide3& a, const Wide3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

HWY_INLINE Floats outside(Floats lower, Floats upper, Floats at) {
  const Floats zero = hn::Zero(FloatTag());
  return hn::Max(hn::Max(hn::Sub(lower, at), hn::Sub(at, upper)), zero);
}

// A bit for each lane that is not above the limit, or not a number.
HWY_INLINE unsigned bits_not_above(Floats values, float limit) {
  const FloatTag d;
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, hn::Not(hn::Gt(values, hn::Set(d, limit))), bits);
  return bits[0];
}

// Squared lower bounds of a node's children from `i` on, see octree/bounds.h.
HWY_INLINE Floats child_bounds(const Node& node, const Wide3& p, bool discs, std::size_t i) {
  const FloatTag d;
  const Wide3 lower{hn::Load(d, node.lower[0] + i), hn::Load(d, node.lower[1] + i),
                    hn::Load(d, node.lower[2] + i)};
  const Wide3 upper{hn::Load(d, node.upper[0] + i), hn::Load(d, node.upper[1] + i),
                    hn::Load(d, node.upper[2] + i)};
  const Wide3 gap{outside(lower.x, upper.x, p.x), outside(lower.y, upper.y, p.y),
                  outside(lower.z, upper.z, p.z)};
  const Floats bound = dot(gap, gap);
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
  const Floats off =
      outside(hn::Load(d, node.slab_lower + i), hn::Load(d, node.slab_upper + i), height);
  const Floats kept = hn::Mul(dot(from, from), hn::Set(d, 1.0f - kCancellation));
  const Floats aside = hn::Sqrt(hn::Max(hn::Sub(kept, hn::Mul(height, height)), zero));
  const Floats beyond = hn::Max(hn::Sub(aside, hn::Load(d, node.radius + i)), zero);
  return hn::Max(bound, hn::Add(hn::Mul(off, off), hn::Mul(beyond, beyond)));
}

// Bits of a bound that name the child instead.
inline constexpr std::int32_t kChildBits = kFanOut - 1;
inline constexpr std::int32_t kNoChild = std::numeric_limits<std::int32_t>::max();

// A child's bound and its number, in an order that all targets agree on.
HWY_INLINE Ints child_keys(const Node& node, const Wide3& p, bool discs, std::size_t i) {
  const IntTag d;
  const Ints bits = hn::BitCast(d, child_bounds(node, p, discs, i));
  return hn::Or(hn::AndNot(hn::Set(d, kChildBits), bits),
                hn::Iota(d, static_cast<std::int32_t>(i)));
}

#if PLANETREE_EIGHT_LANES
// Sorts eight integers within a register, by a bitonic network.
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

// Writes a node's children, nearest first, and returns how many of them have bounds
// that are not above the threshold. Bounds lose their kChildBits.
HWY_INLINE unsigned sorted_children(const Node& node, const FloatQuery& query, bool discs,
                                    float threshold, FrontierGroup& group) {
  const FloatTag d;
  const IntTag di;
  const Wide3 p{hn::Set(d, query.x), hn::Set(d, query.y), hn::Set(d, query.z)};
  const std::int32_t most = std::bit_cast<std::int32_t>(threshold) | kChildBits;
#if PLANETREE_EIGHT_LANES
  const hn::RebindToUnsigned<IntTag> du;
  const auto used = hn::Lt(hn::Iota(di, 0), hn::Set(di, node.child_count));
  const Ints keys =
      sort_lanes(hn::IfThenElse(used, child_keys(node, p, discs, 0), hn::Set(di, kNoChild)));
  const auto child = hn::IndicesFromVec(du, hn::And(keys, hn::Set(di, kChildBits)));
  hn::Store(hn::AndNot(hn::Set(di, kChildBits), keys), di, group.bound_bits);
  hn::Store(hn::TableLookupLanes(hn::Load(du, node.link), child), du, group.link);
  return static_cast<unsigned>(hn::CountTrue(di, hn::Not(hn::Gt(keys, hn::Set(di, most)))));
#else
  HWY_ALIGN std::int32_t keys[kFanOut];
  for (std::size_t i = 0; i < kFanOut; i += hn::Lanes(d))
    hn::Store(child_keys(node, p, discs, i), di, keys + i);
  // The compiler cannot know that there are no more.
  std::sort(keys, keys + std::min<std::size_t>(node.child_count, kFanOut));
  unsigned count = 0;
  for (unsigned i = 0; i < node.child_count; ++i) {
    group.bound_bits[i] = keys[i] & ~kChildBits;
    group.link[i] = node.link[keys[i] & kChildBits];
    count += keys[i] <= most ? 1 : 0;
  }
  return count;
#endif
}

// A bit for each child whose box is not above the threshold.
HWY_INLINE unsigned near_children(const Node& node, const FloatQuery& query, float threshold) {
  const FloatTag d;
  const Wide3 p{hn::Set(d, query.x), hn::Set(d, query.y), hn::Set(d, query.z)};
  unsigned near = 0;
  for (std::size_t i = 0; i < kFanOut; i += hn::Lanes(d))
    near |= bits_not_above(child_bounds(node, p, false, i), threshold) << i;
  return near & ((1u << node.child_count) - 1);
}

// Squared distance to the segment from a point `p2` away, squared, from the query, along
// an edge; `along` is the edge times the vector to the query. The products of a triangle's
// sides do for all of it: what cancels is paid for by kEdgeError.
HWY_INLINE Floats segment_squared(Floats p2, Floats along, Floats edge2) {
  const FloatTag d;
  const Floats least = hn::Set(d, 0x1p-126f);
  const Floats one = hn::Set(d, 1.0f);
  const Floats t = hn::Min(hn::Max(hn::Div(along, hn::Max(edge2, least)), hn::Zero(d)), one);
  return hn::Sub(p2, hn::Mul(t, hn::Sub(hn::Add(along, along), hn::Mul(t, edge2))));
}

// Squared distances of triangles as float sees them: on either side of the true one, but
// for the rounding of the corners, which is kFilterSlack's.
struct TriangleBounds {
  Floats lower;  // 0 where float cannot tell
  Floats upper;
};

// Of a face too flat for float: it lies within its own height of its edges.
HWY_INLINE Floats flat_lower(Floats edges, Floats whole, Floats sides, Floats longest2) {
  const FloatTag d;
  const Floats zero = hn::Zero(d);
  const Floats doubt = hn::Add(hn::Mul(sides, hn::Set(d, 0x1p-18f)), hn::Set(d, 0x1p-99f));
  const Floats rise = hn::Div(hn::Sqrt(hn::Add(hn::Max(whole, zero), doubt)), hn::Sqrt(longest2));
  const Floats flat = hn::Max(hn::Sub(hn::Sqrt(edges), rise), zero);
  return hn::IfThenElseZero(hn::Gt(longest2, hn::Set(d, 0x1p-90f)), hn::Mul(flat, flat));
}

// Of triangles given by vectors from the query to corners.
HWY_INLINE TriangleBounds triangle_bounds(const Wide3& a, const Wide3& b, const Wide3& c) {
  const FloatTag d;
  const Floats zero = hn::Zero(d);
  const Wide3 ab = sub(b, a), ac = sub(c, a);
  const Floats a2 = dot(a, a), ab2 = dot(ab, ab), ac2 = dot(ac, ac), ab_ac = dot(ab, ac);
  const Floats to_b = hn::Neg(dot(a, ab)), to_c = hn::Neg(dot(a, ac));
  // The third side and its start, from the products of the others.
  const Floats b2 = hn::Sub(hn::Add(a2, ab2), hn::Add(to_b, to_b));
  const Floats bc2 = hn::Sub(hn::Add(ab2, ac2), hn::Add(ab_ac, ab_ac));
  const Floats b_to_c = hn::Sub(hn::Add(to_c, ab2), hn::Add(to_b, ab_ac));
  const Floats edges =
      hn::Min(hn::Min(segment_squared(a2, to_b, ab2), segment_squared(a2, to_c, ac2)),
              segment_squared(b2, b_to_c, bc2));
  const Floats edge_error = hn::Mul(hn::Add(a2, hn::Add(ab2, ac2)), hn::Set(d, kEdgeError));

  const Floats sides = hn::Mul(ab2, ac2);
  const Floats whole = hn::Sub(sides, hn::Mul(ab_ac, ab_ac));
  const Floats v = hn::Sub(hn::Mul(ac2, to_b), hn::Mul(ab_ac, to_c));
  const Floats w = hn::Sub(hn::Mul(ab2, to_c), hn::Mul(ab_ac, to_b));
  const auto inside =
      hn::And(hn::And(hn::Gt(v, zero), hn::Gt(w, zero)), hn::Lt(hn::Add(v, w), whole));
  const Floats inverse = hn::Div(hn::Set(d, 1.0f), whole);
  // Shares of b and c first: products of three short sides underflow.
  const Floats face =
      hn::Sub(a2, hn::Add(hn::Mul(hn::Mul(v, inverse), to_b), hn::Mul(hn::Mul(w, inverse), to_c)));
  const Floats face_error = hn::Mul(hn::Mul(a2, hn::Set(d, kFaceError)), hn::Mul(sides, inverse));

  const Floats squared = hn::IfThenElse(inside, face, edges);
  const Floats error = hn::IfThenElse(inside, face_error, edge_error);
  const Floats lower = hn::Max(hn::Sub(squared, error), zero);
  const Floats upper = hn::Add(squared, error);
  const auto round = hn::And(hn::Ge(whole, hn::Mul(hn::Set(d, kFlatSine2), sides)),
                             hn::Ge(whole, hn::Set(d, 0x1p-100f)));
  if (hn::AllTrue(d, round)) return {lower, upper};
  const Floats least = hn::Max(hn::Sub(edges, edge_error), zero);
  const Floats flat = flat_lower(least, whole, sides, hn::Max(hn::Max(ab2, ac2), bc2));
  return {hn::IfThenElse(round, lower, flat),
          hn::IfThenElse(round, upper, hn::Add(edges, edge_error))};
}

// All of a block's vertices, seen from the query.
class VertexRows {
 public:
  // `local` is relative to the block, `query` to its vertex 0.
  HWY_INLINE VertexRows(const float* HWY_RESTRICT local, unsigned stride, const float (&query)[3])
      : stride_(stride) {
    const FloatTag d;
    for (unsigned axis = 0; axis < 3; ++axis, local += stride) {
      const Floats first = hn::Set(d, local[0]);
      const Floats q = hn::Set(d, query[axis]);
      for (unsigned i = 0; i < stride; i += static_cast<unsigned>(hn::Lanes(d)))
        hn::Store(hn::Sub(hn::Sub(hn::Load(d, local + i), first), q), d, row_[axis] + i);
    }
  }

  // The vertices that a vector of corners names.
  HWY_INLINE Wide3 at(const std::uint8_t* HWY_RESTRICT corners) const {
    const FloatTag d;
    const IntTag di;
    const Ints index = hn::PromoteTo(di, hn::LoadU(hn::Rebind<std::uint8_t, IntTag>(), corners));
#if PLANETREE_EIGHT_LANES
    // A gather costs more than looking each vector of a row up in registers.
    const auto lane = hn::IndicesFromVec(d, hn::And(index, hn::Set(di, 7)));
    const auto look_up = [&](unsigned axis, unsigned i) {
      return hn::TableLookupLanes(hn::Load(d, row_[axis] + i), lane);
    };
    Wide3 found{look_up(0, 0), look_up(1, 0), look_up(2, 0)};
    for (unsigned i = 8; i < stride_; i += 8) {
      const auto here = hn::RebindMask(d, hn::Gt(index, hn::Set(di, static_cast<int>(i) - 1)));
      found.x = hn::IfThenElse(here, look_up(0, i), found.x);
      found.y = hn::IfThenElse(here, look_up(1, i), found.y);
      found.z = hn::IfThenElse(here, look_up(2, i), found.z);
    }
    return found;
#else
    return {hn::GatherIndex(d, row_[0], index), hn::GatherIndex(d, row_[1], index),
            hn::GatherIndex(d, row_[2], index)};
#endif
  }

 private:
  HWY_ALIGN float row_[3][kMaxBlockVertices];
  [[maybe_unused]] unsigned stride_;  // a gather does without
};

// What float says of a block's triangles.
struct BlockFilter {
  HWY_ALIGN float squared[kMaxBlockTriangles];  // see TriangleBounds::lower
  unsigned near;                                // a bit for each that is not above the limit
  float least_upper;                            // of TriangleBounds::upper
};

// `query` is relative to vertex 0. Lanes past the last triangle repeat it.
HWY_INLINE void filter_block(const BlockHeader& block, const float (&query)[3], float limit,
                             BlockFilter& filter) {
  const FloatTag d;
  const VertexRows vertices(reinterpret_cast<const float*>(&block + 1), block.stride, query);
  Floats least = hn::Set(d, std::numeric_limits<float>::infinity());
  unsigned near = 0;
  for (std::size_t i = 0; i < block.triangle_count; i += hn::Lanes(d)) {
    const TriangleBounds bounds =
        triangle_bounds(vertices.at(block.corner[0] + i), vertices.at(block.corner[1] + i),
                        vertices.at(block.corner[2] + i));
    hn::Store(bounds.lower, d, filter.squared + i);
    least = hn::Min(least, bounds.upper);
    near |= bits_not_above(bounds.lower, limit) << i;
  }
  filter.near = near & ((1u << block.triangle_count) - 1);
  filter.least_upper = hn::GetLane(hn::MinOfLanes(d, least));
}

// Those that a lower limit leaves; of lanes that `filter.near` leaves out, anything.
HWY_INLINE unsigned near_triangles(const BlockFilter& filter, float limit) {
  const FloatTag d;
  unsigned near = 0;
  for (std::size_t i = 0; i < kMaxBlockTriangles; i += hn::Lanes(d))
    near |= bits_not_above(hn::Load(d, filter.squared + i), limit) << i;
  return near;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
