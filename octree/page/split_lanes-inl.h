// Loads elements of byte-stream split arrays (ByteSplit, octree/page/byte_split.h) into registers
// of 16 bytes. Compiled once for each instruction set that Highway targets, except the scalar one,
// which has no such registers.

#if defined(PLANETREE_OCTREE_SPLIT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_SPLIT_LANES_INL_H_
#undef PLANETREE_OCTREE_SPLIT_LANES_INL_H_
#else
#define PLANETREE_OCTREE_SPLIT_LANES_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

using ByteTag = hn::FixedTag<std::uint8_t, 16>;
using PairTag = hn::Repartition<std::uint16_t, ByteTag>;
using QuadTag = hn::Repartition<std::uint32_t, ByteTag>;
using Bytes = hn::Vec<ByteTag>;
using Pairs = hn::Vec<PairTag>;
using Quads = hn::Vec<QuadTag>;

// Returns eight elements from `first` on of an array of `count` two-byte elements.
HWY_INLINE Pairs load_eight(const std::byte* byte_split, std::size_t count, std::size_t first) {
  const PairTag pairs;
  const hn::Rebind<std::uint8_t, PairTag> bytes;
  const auto* low = reinterpret_cast<const std::uint8_t*>(byte_split) + first;
  return hn::Or(hn::PromoteTo(pairs, hn::LoadU(bytes, low)),
                hn::ShiftLeft<8>(hn::PromoteTo(pairs, hn::LoadU(bytes, low + count))));
}

// Loads sixteen elements from `first` on of an array of `count` four-byte elements, as four planes:
// all first bytes, all second bytes and so on.
HWY_INLINE void load_sixteen(const std::byte* byte_split, std::size_t count, std::size_t first,
                             Bytes (&planes)[4]) {
  const auto* at = reinterpret_cast<const std::uint8_t*>(byte_split) + first;
  for (std::size_t k = 0; k < 4; ++k) planes[k] = hn::LoadU(ByteTag(), at + k * count);
}

// Joins the planes of load_sixteen() to elements.
HWY_INLINE void join_planes(const Bytes (&planes)[4], Quads (&elements)[4]) {
  const ByteTag bytes;
  const PairTag pairs;
  const QuadTag quads;
  const Pairs low0 = hn::BitCast(pairs, hn::InterleaveLower(bytes, planes[0], planes[1]));
  const Pairs low1 = hn::BitCast(pairs, hn::InterleaveUpper(bytes, planes[0], planes[1]));
  const Pairs high0 = hn::BitCast(pairs, hn::InterleaveLower(bytes, planes[2], planes[3]));
  const Pairs high1 = hn::BitCast(pairs, hn::InterleaveUpper(bytes, planes[2], planes[3]));
  elements[0] = hn::BitCast(quads, hn::InterleaveLower(pairs, low0, high0));
  elements[1] = hn::BitCast(quads, hn::InterleaveUpper(pairs, low0, high0));
  elements[2] = hn::BitCast(quads, hn::InterleaveLower(pairs, low1, high1));
  elements[3] = hn::BitCast(quads, hn::InterleaveUpper(pairs, low1, high1));
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
