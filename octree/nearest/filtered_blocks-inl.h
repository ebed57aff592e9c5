// Blocks that were filtered in float, until their triangles become candidates.

#if defined(PLANETREE_OCTREE_FILTERED_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_FILTERED_BLOCKS_INL_H_
#undef PLANETREE_OCTREE_FILTERED_BLOCKS_INL_H_
#else
#define PLANETREE_OCTREE_FILTERED_BLOCKS_INL_H_
#endif

#include <bit>

#include "octree/page/block_view.h"
#include "octree/traversal/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Blocks with the filter values of their triangles. Candidates are taken from them later: when
// more of the tree has been visited, the limit is lower and fewer triangles pass it.
class FilteredBlocks {
 public:
  static constexpr unsigned kMax = 8;

  bool empty() const { return size_ == 0; }
  bool full() const { return size_ == kMax; }

  // The filter's result for a block is written to next(), then counted in by add(). Both require
  // !full().
  FilteredTriangles& next() { return triangles_[size_]; }
  void add(const BlockHeader& block) { block_[size_++] = &block; }

  // Calls note(block, i, squared) for each triangle whose lower bound is not above
  // limit_of(extent of the block), then empties the list. The frames of the blocks must still be
  // valid.
  template <class LimitOf, class Note>
  HWY_INLINE void take_near(const BlockShape& shape, const LimitOf& limit_of, const Note& note) {
    for (unsigned at = 0; at < size_; ++at) {
      const BlockView block(*block_[at], shape);
      const FilteredTriangles& filtered = triangles_[at];
      const float limit = limit_of(block.header().extent);
      unsigned near = near_triangles(filtered, block.triangle_count(), limit);
      for (; near != 0; near &= near - 1) {
        const auto i = static_cast<unsigned>(std::countr_zero(near));
        note(block, i, filtered.squared[i]);
      }
    }
    size_ = 0;
  }

 private:
  unsigned size_ = 0;
  const BlockHeader* block_[kMax];
  FilteredTriangles triangles_[kMax];
};

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
