// Loads records of a frame into registers: the sides of the boxes of a node's children, with the
// same bits as child_box(); the corners of a block's triangles relative to a query; and codes of
// these triangles. A code is a byte with one bit for each property of a vertex.

#ifndef PLANETREE_OCTREE_FRAME_LANES_
#define PLANETREE_OCTREE_FRAME_LANES_  // once for all targets

namespace planetree::octree {

struct CornerCodes {
  unsigned shared;  // a bit for each triangle whose corners have a bit in common
  unsigned none;    // a bit for each triangle with a corner of code 0
};

}  // namespace planetree::octree
#endif

#if defined(PLANETREE_OCTREE_FRAME_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_FRAME_LANES_INL_H_
#undef PLANETREE_OCTREE_FRAME_LANES_INL_H_
#else
#define PLANETREE_OCTREE_FRAME_LANES_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "octree/geometry/wide_floats-inl.h"
#include "octree/page/frame.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Loads and widens as many bytes as a register has lanes.
HWY_INLINE Ints widened_bytes(const std::uint8_t* bytes) {
  const hn::Rebind<std::uint8_t, IntTag> narrow;
  return hn::PromoteTo(IntTag(), hn::LoadU(narrow, bytes));
}

// Returns the sides along one axis of the children from `i` on.
HWY_INLINE Floats lower_sides(const Node& node, std::size_t axis, std::size_t i) {
  const FloatTag d;
  const Floats steps = hn::ConvertTo(d, widened_bytes(node.lower[axis] + i));
  return hn::Add(hn::Set(d, node.box.lower[axis]), hn::Mul(steps, hn::Set(d, node.step[axis])));
}
HWY_INLINE Floats upper_sides(const Node& node, std::size_t axis, std::size_t i) {
  const FloatTag d;
  const Floats steps = hn::ConvertTo(d, widened_bytes(node.upper[axis] + i));
  return hn::Sub(hn::Set(d, node.box.upper[axis]), hn::Mul(steps, hn::Set(d, node.step[axis])));
}

// A block's vertices relative to a query, `kStride` of each coordinate.
template <unsigned kStride, bool kCompact>
class BlockTriangles {
 public:
  // query  position of the query relative to vertex 0
  HWY_INLINE BlockTriangles(const BlockHeader& block, const float (&query)[3]) : block_(block) {
    const RowTag d;
    const float* HWY_RESTRICT local = reinterpret_cast<const float*>(&block + 1);
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis, local += kStride) {
      const auto first = hn::Set(d, local[0]);
      const auto q = hn::Set(d, query[axis]);
#pragma GCC unroll 12
      for (unsigned i = 0; i < kVectors; ++i)
        set_row(axis, i, hn::Sub(hn::Sub(hn::LoadU(d, local + i * kLanes), first), q));
    }
  }

  // Returns corner `k` of the triangles from `first` on.
  HWY_INLINE TriangleVectors corner(std::size_t k, std::size_t first) const {
    const auto index = vertices(k, first);
    return {look_up(0, index), look_up(1, index), look_up(2, index)};
  }

 private:
  HWY_INLINE hn::Vec<hn::RebindToSigned<TriangleTag>> vertices(std::size_t k,
                                                               std::size_t first) const {
    const hn::RebindToSigned<TriangleTag> di;
    if constexpr (!kCompact) {
      const hn::Rebind<std::uint8_t, decltype(di)> bytes;
      return hn::PromoteTo(di, hn::LoadU(bytes, block_.corner_row(k) + first));
    } else {
#if HWY_TARGET == HWY_SCALAR
      return hn::Set(di,
                     static_cast<std::int32_t>(block_.corners(static_cast<unsigned>(first))[k]));
#else
      // The corner of each lane is shifted down from its corner_bit().
      const hn::RebindToUnsigned<decltype(di)> du;
      const hn::Repartition<std::uint64_t, decltype(di)> words;
      const auto packed = hn::BitCast(du, hn::Set(words, block_.packed_corners[k] >> 2 * first));
      const auto lane = hn::Iota(du, 0);
      const auto shift = hn::ShiftLeft<1>(hn::AndNot(hn::Set(du, 1), lane));
      return hn::BitCast(di, hn::And(hn::Shr(packed, shift), hn::Set(du, 15)));
#endif
    }
  }

  // Whole vectors of a row. The last one may read beyond the row, since the block goes on behind
  // its last row; the extra values are not used.
  using RowTag = TriangleTag;
  static constexpr unsigned kLanes = static_cast<unsigned>(hn::MaxLanes(RowTag()));
  static constexpr unsigned kVectors = (kStride + kLanes - 1) / kLanes;

#if PLANETREE_EIGHT_LANES
  static constexpr std::int32_t kLaneBits = std::int32_t{kLanes} - 1;

  HWY_INLINE void set_row(unsigned axis, unsigned i, TriangleFloats row) { row_[axis][i] = row; }

  // Looks the index up in each vector of the row; a lookup uses only the lowest bits of the index.
  // A gather would take longer.
  template <class Index>
  HWY_INLINE TriangleFloats look_up(unsigned axis, Index index) const {
    const TriangleTag d;
    const hn::DFromV<Index> di;
    const auto lane = hn::IndicesFromVec(d, hn::And(index, hn::Set(di, kLaneBits)));
    TriangleFloats found = hn::TableLookupLanes(row_[axis][0], lane);
#pragma GCC unroll 5
    for (unsigned i = 1; i < kVectors; ++i) {
      const auto last = static_cast<std::int32_t>(i * kLanes) - 1;
      const auto here = hn::RebindMask(d, hn::Gt(index, hn::Set(di, last)));
      found = hn::IfThenElse(here, hn::TableLookupLanes(row_[axis][i], lane), found);
    }
    return found;
  }

  TriangleFloats row_[3][kVectors];
#else
  HWY_INLINE void set_row(unsigned axis, unsigned i, TriangleFloats row) {
    hn::Store(row, RowTag(), row_[axis] + i * kLanes);
  }
  template <class Index>
  HWY_INLINE TriangleFloats look_up(unsigned axis, Index index) const {
    return hn::GatherIndex(TriangleTag(), row_[axis], index);
  }

  HWY_ALIGN float row_[3][kVectors * kLanes];
#endif
  const BlockHeader& block_;
};

// Calls look<stride, compact>() with the layout of the block's vertices and corners.
template <class Look>
HWY_INLINE auto by_layout(const BlockHeader& block, const Look& look) {
  if (block.compact()) return look.template operator()<BlockHeader::kMaxCompactVertices, true>();
  switch (block.stride()) {
    case 16:
      return look.template operator()<16, false>();
    case 24:
      return look.template operator()<24, false>();
    case 32:
      return look.template operator()<32, false>();
    default:
      return look.template operator()<kMaxBlockVertices, false>();
  }
}

#if PLANETREE_EIGHT_LANES
using CodeTag = hn::FixedTag<std::uint8_t, kMaxBlockTriangles>;

// Returns the vertex of corner `corner` of each triangle.
HWY_INLINE hn::Vec<CodeTag> corner_lanes(const BlockHeader& block, unsigned corner) {
  const CodeTag d;
  if (!block.compact()) return hn::LoadU(d, block.corner_row(corner));
  // Two triangles of the same parity share a byte.
  static constexpr std::uint8_t kByte[] = {0, 4, 0, 4, 1, 5, 1, 5, 2, 6, 2, 6, 3, 7, 3, 7};
  static constexpr std::uint8_t kUpper[] = {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1};
  const hn::Repartition<std::uint64_t, CodeTag> words;
  const auto packed = hn::BitCast(d, hn::Set(words, block.packed_corners[corner]));
  const auto found = hn::TableLookupBytes(packed, hn::LoadU(d, kByte));
  const auto lower = hn::Eq(hn::LoadU(d, kUpper), hn::Zero(d));
  const auto shifted = hn::BitCast(d, hn::ShiftRight<4>(hn::BitCast(words, found)));
  return hn::And(hn::IfThenElse(lower, found, shifted), hn::Set(d, 15));
}

// Returns the code of corner `corner` of each triangle.
HWY_INLINE hn::Vec<CodeTag> codes_of(const BlockHeader& block, unsigned corner,
                                     const std::uint8_t* HWY_RESTRICT codes) {
  const CodeTag d;
  const auto index = corner_lanes(block, corner);
  auto found = hn::Zero(d);
  // Indices outside of these 16 vertices become 128 or more; the lookup returns 0 for them.
  for (unsigned i = 0; i < block.stride(); i += kMaxBlockTriangles) {
    const auto here = hn::SaturatedAdd(hn::Sub(index, hn::Set(d, static_cast<std::uint8_t>(i))),
                                       hn::Set(d, 0x80 - kMaxBlockTriangles));
    found = hn::Or(found, hn::TableLookupBytesOr0(hn::LoadU(d, codes + i), here));
  }
  return found;
}

HWY_INLINE CornerCodes corner_codes(const BlockHeader& block,
                                    const std::uint8_t* HWY_RESTRICT codes) {
  const CodeTag d;
  const auto zero = hn::Zero(d);
  auto shared = hn::Set(d, 0xff);
  auto some_clear = hn::FirstN(d, 0);
  for (unsigned corner = 0; corner < 3; ++corner) {
    const auto found = codes_of(block, corner, codes);
    shared = hn::And(shared, found);
    some_clear = hn::Or(some_clear, hn::Eq(found, zero));
  }
  return {mask_bits(d, hn::Not(hn::Eq(shared, zero))), mask_bits(d, some_clear)};
}

// Writes for each triangle the bits that all of its corners have.
HWY_INLINE void shared_codes(const BlockHeader& block, const std::uint8_t* HWY_RESTRICT codes,
                             std::uint8_t* HWY_RESTRICT shared) {
  hn::StoreU(hn::And(codes_of(block, 0, codes),
                     hn::And(codes_of(block, 1, codes), codes_of(block, 2, codes))),
             CodeTag(), shared);
}
#else
HWY_INLINE void shared_codes(const BlockHeader& block, const std::uint8_t* HWY_RESTRICT codes,
                             std::uint8_t* HWY_RESTRICT shared) {
  for (unsigned i = 0; i < block.triangle_count; ++i) {
    const auto corners = block.corners(i);
    shared[i] = codes[corners[0]] & codes[corners[1]] & codes[corners[2]];
  }
}

HWY_INLINE CornerCodes corner_codes(const BlockHeader& block,
                                    const std::uint8_t* HWY_RESTRICT codes) {
  CornerCodes found{};
  for (unsigned i = 0; i < block.triangle_count; ++i) {
    const auto corners = block.corners(i);
    const std::uint8_t a = codes[corners[0]], b = codes[corners[1]], c = codes[corners[2]];
    found.shared |= static_cast<unsigned>((a & b & c) != 0) << i;
    found.none |= static_cast<unsigned>(a == 0 || b == 0 || c == 0) << i;
  }
  return found;
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
