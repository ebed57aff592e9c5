// What a block's triangles have of their corners' codes: bytes of a bit for each thing that
// may be true of a vertex.

#ifndef PLANETREE_OCTREE_CORNER_CODES_
#define PLANETREE_OCTREE_CORNER_CODES_  // once for all targets
namespace planetree::octree {

struct CornerCodes {
  unsigned shared;  // a bit for each that has a bit in all three
  unsigned none;    // a bit for each that has a corner without any
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

#include "octree/frame.h"
#include "octree/wide_floats-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if PLANETREE_EIGHT_LANES
HWY_INLINE CornerCodes corner_codes(const BlockHeader& block,
                                    const std::uint8_t* HWY_RESTRICT codes) {
  const hn::FixedTag<std::uint8_t, kMaxBlockTriangles> d;
  const auto zero = hn::Zero(d);
  auto shared = hn::Set(d, 0xff);
  auto some_clear = hn::FirstN(d, 0);
  for (const auto& corner : block.corner) {
    const auto index = hn::LoadU(d, corner);
    auto found = zero;
    // Bytes from 128 on look nothing up.
    for (unsigned i = 0; i < block.stride; i += kMaxBlockTriangles) {
      const auto here = hn::SaturatedAdd(hn::Sub(index, hn::Set(d, static_cast<std::uint8_t>(i))),
                                         hn::Set(d, 0x80 - kMaxBlockTriangles));
      found = hn::Or(found, hn::TableLookupBytesOr0(hn::LoadU(d, codes + i), here));
    }
    shared = hn::And(shared, found);
    some_clear = hn::Or(some_clear, hn::Eq(found, zero));
  }
  return {mask_bits(d, hn::Not(hn::Eq(shared, zero))), mask_bits(d, some_clear)};
}
#else
HWY_INLINE CornerCodes corner_codes(const BlockHeader& block,
                                    const std::uint8_t* HWY_RESTRICT codes) {
  CornerCodes found{};
  for (unsigned i = 0; i < block.triangle_count; ++i) {
    const std::uint8_t a = codes[block.corner[0][i]], b = codes[block.corner[1][i]],
                       c = codes[block.corner[2][i]];
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
