// Compaction: moves selected lanes of a register to its front. Compiled once for each instruction
// set that Highway targets.

#if defined(PLANETREE_OCTREE_PACKED_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_PACKED_LANES_INL_H_
#undef PLANETREE_OCTREE_PACKED_LANES_INL_H_
#else
#define PLANETREE_OCTREE_PACKED_LANES_INL_H_
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "octree/geometry/wide_floats-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
