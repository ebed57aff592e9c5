// Vectors of floats, points made of them, bits of masks, and compaction: moving selected lanes of a
// register to its front. Compiled once for each instruction set that Highway targets.
// Multiplications and additions are never fused and lanes are never mixed, so that all instruction
// sets compute the same bits.

#if defined(PLANETREE_OCTREE_WIDE_FLOATS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_WIDE_FLOATS_INL_H_
#undef PLANETREE_OCTREE_WIDE_FLOATS_INL_H_
#else
#define PLANETREE_OCTREE_WIDE_FLOATS_INL_H_
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "octree/geometry/tree_limits.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Whether one register holds eight floats and has operations across all of them.
#undef PLANETREE_EIGHT_LANES
#define PLANETREE_EIGHT_LANES (HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2)

using FloatTag = hn::CappedTag<float, kFanOut>;
using IntTag = hn::RebindToSigned<FloatTag>;
using Floats = hn::Vec<FloatTag>;
using Ints = hn::Vec<IntTag>;

// Lanes for lists longer than a node's children: a block's triangles, or a part of them.
using TriangleTag = hn::CappedTag<float, kMaxBlockTriangles>;
using TriangleFloats = hn::Vec<TriangleTag>;

// A vector of three coordinates in each lane.
template <class Lanes>
struct Vectors {
  Lanes x, y, z;
};
using Wide3 = Vectors<Floats>;
using TriangleVectors = Vectors<TriangleFloats>;

template <class Lanes>
HWY_INLINE Vectors<Lanes> sub(const Vectors<Lanes>& a, const Vectors<Lanes>& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

template <class Lanes>
HWY_INLINE Lanes dot(const Vectors<Lanes>& a, const Vectors<Lanes>& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

template <class Lanes>
HWY_INLINE Lanes outside(Lanes lower, Lanes upper, Lanes at) {
  const Lanes zero = hn::Zero(hn::DFromV<Lanes>());
  return hn::Max(hn::Max(hn::Sub(lower, at), hn::Sub(at, upper)), zero);
}

// Returns a bit for each lane, at most 16.
template <class Tag, class Mask>
HWY_INLINE unsigned mask_bits(Tag d, Mask mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return bytes[0] | unsigned{bytes[1]} << 8;
}

// Returns a bit for each lane that is not above the limit, NaN included.
template <class Lanes>
HWY_INLINE unsigned bits_not_above(Lanes values, float limit) {
  const hn::DFromV<Lanes> d;
  return mask_bits(d, hn::Not(hn::Gt(values, hn::Set(d, limit))));
}

#if HWY_TARGET == HWY_AVX2
// For each mask of eight lanes the numbers of the selected lanes, one a byte, the first in the
// lowest byte.
inline constexpr std::array<std::uint64_t, 256> kLanesByMask = [] {
  std::array<std::uint64_t, 256> lanes{};
  for (unsigned mask = 0; mask < lanes.size(); ++mask)
    for (unsigned lane = 0, at = 0; lane < 8; ++lane)
      if ((mask >> lane & 1) != 0) lanes[mask] |= std::uint64_t{lane} << 8 * at++;
  return lanes;
}();
#endif

// The selected lanes of registers of 32-bit numbers. `Tag` is one of these.
template <class Tag>
class PackedLanes {
 public:
  HWY_INLINE PackedLanes(Tag d, hn::Mask<Tag> mask) : mask_(mask), count_(hn::CountTrue(d, mask)) {
#if HWY_TARGET == HWY_AVX2
    const hn::RebindToUnsigned<Tag> du;
    const hn::Rebind<std::uint8_t, decltype(du)> bytes;
    const auto* at = reinterpret_cast<const std::uint8_t*>(&kLanesByMask[mask_bits(d, mask)]);
    lanes_ = hn::PromoteTo(du, hn::LoadU(bytes, at));
#endif
  }

  std::size_t count() const { return count_; }

  // Writes a whole register: the count() selected numbers, then unspecified ones.
  template <class Lanes, class T>
  HWY_INLINE void store(Lanes values, T* to) const {
    const hn::DFromV<Lanes> d;
#if HWY_TARGET == HWY_AVX2
    // Highway 1.0.3 has a function-local table for this, which gcc 12 copies to the stack.
    const auto packed = hn::TableLookupLanes(values, hn::IndicesFromVec(d, lanes_));
#else
    const auto packed = hn::Compress(values, hn::RebindMask(d, mask_));
#endif
    hn::StoreU(packed, d, to);
  }

 private:
  hn::Mask<Tag> mask_;
  std::size_t count_;
#if HWY_TARGET == HWY_AVX2
  hn::Vec<hn::RebindToUnsigned<Tag>> lanes_;
#endif
};

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
