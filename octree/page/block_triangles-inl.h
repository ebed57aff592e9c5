// Corners of a block's triangles relative to a query. The vertices are kept in registers and looked
// up by corner.

#if defined(PLANETREE_OCTREE_BLOCK_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_BLOCK_TRIANGLES_INL_H_
#undef PLANETREE_OCTREE_BLOCK_TRIANGLES_INL_H_
#else
#define PLANETREE_OCTREE_BLOCK_TRIANGLES_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "octree/geometry/wide_floats-inl.h"
#include "octree/page/frame.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
