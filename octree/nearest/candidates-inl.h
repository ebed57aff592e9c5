// What the float filter leaves to be evaluated in double: blocks with the filter values of their
// triangles, and triangles copied from them.

#ifndef PLANETREE_OCTREE_CANDIDATES_
#define PLANETREE_OCTREE_CANDIDATES_  // once for all targets

#include <cstddef>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"

namespace planetree::octree {

/// A short list of triangles that float cannot rule out. They are evaluated in double when little
/// is likely to be found that is nearer. Corners are copied, because their page may be gone by
/// then.
class Candidates {
 public:
  static constexpr std::size_t kMax = 32;

  std::size_t size() const { return size_; }
  bool full() const { return size_ == kMax; }

  /// Adds a triangle. Requires !full().
  ///
  /// extent, is_height_field  of the triangle's block
  /// squared                  filter value, see octree/traversal/bounds.h
  void add(const Triangle& corners, std::uint64_t id, float extent, bool is_height_field,
           float squared) {
    // The first triangle of a group fills all lanes of it, so that kernels need no mask.
    if (size_ % kTrianglesAtOnce == 0)
      rows_.fill(size_, corners);
    else
      rows_.set(size_, corners);
    id_[size_] = id;
    extent_[size_] = extent;
    is_height_field_[size_] = is_height_field;
    squared_[size_++] = squared;
  }

  /// Removes the candidates for which still(squared, extent) is false.
  template <class Still>
  void keep_if(Still still) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      if (!still(squared_[i], extent_[i])) continue;
      if (kept < i) copy(i, kept);
      ++kept;
    }
    size_ = kept;
  }

  void clear() { size_ = 0; }

  /// Rows from size() up to the next multiple of kTrianglesAtOnce hold triangles without meaning.
  const TriangleRows<kMax>& rows() const { return rows_; }
  std::uint64_t id(std::size_t at) const { return id_[at]; }
  bool is_height_field(std::size_t at) const { return is_height_field_[at]; }

 private:
  void copy(std::size_t from, std::size_t to) {
    rows_.copy(from, to);
    id_[to] = id_[from];
    extent_[to] = extent_[from];
    is_height_field_[to] = is_height_field_[from];
    squared_[to] = squared_[from];
  }

  std::size_t size_ = 0;
  TriangleRows<kMax> rows_;
  std::uint64_t id_[kMax];
  float extent_[kMax];
  bool is_height_field_[kMax];
  float squared_[kMax];
};

}  // namespace planetree::octree
#endif

#if defined(PLANETREE_OCTREE_CANDIDATES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_CANDIDATES_INL_H_
#undef PLANETREE_OCTREE_CANDIDATES_INL_H_
#else
#define PLANETREE_OCTREE_CANDIDATES_INL_H_
#endif

#include <bit>

#include "octree/page/frame.h"
#include "octree/traversal/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

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
