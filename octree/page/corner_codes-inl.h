// Combines the codes of vertices into codes of a block's triangles. A code is a byte with one bit
// for each property of a vertex.

#ifndef PLANETREE_OCTREE_CORNER_CODES_
#define PLANETREE_OCTREE_CORNER_CODES_  // once for all targets
namespace planetree::octree {

struct CornerCodes {
  unsigned shared;  // a bit for each triangle whose corners have a bit in common
  unsigned none;    // a bit for each triangle with a corner of code 0
};

}  // namespace planetree::octree
#endif

#if defined(PLANETREE_OCTREE_CORNER_CODES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_CORNER_CODES_INL_H_
#undef PLANETREE_OCTREE_CORNER_CODES_INL_H_
#else
#define PLANETREE_OCTREE_CORNER_CODES_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "octree/geometry/wide_floats-inl.h"
#include "octree/page/frame.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
