#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/geometry/triangle_rows.h"

namespace planetree::octree {

/// A short list of triangles that float cannot rule out: to be evaluated in double once
/// nothing nearer is likely to be found. Corners are copied: their page may be gone by then.
class Candidates {
 public:
  static constexpr std::size_t kMost = 32;

  std::size_t size() const { return size_; }
  bool full() const { return size_ == kMost; }

  /// `squared` is the filter's value (octree/traversal/bounds.h), `extent` and `in_sheet` are the
  /// block's.
  void add(const Triangle& corners, std::uint64_t id, float extent, bool in_sheet, float squared) {
    // The first of a group stands in all its lanes, so that kernels need no mask.
    if (size_ % kTrianglesAtOnce == 0)
      rows_.fill(size_, corners);
    else
      rows_.set(size_, corners);
    id_[size_] = id;
    extent_[size_] = extent;
    in_sheet_[size_] = in_sheet;
    squared_[size_++] = squared;
  }

  /// Drops those for which `still(squared, extent)` is false.
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

  /// Up to the next multiple of kTrianglesAtOnce there are triangles, of no meaning.
  const TriangleRows<kMost>& rows() const { return rows_; }
  std::uint64_t id(std::size_t at) const { return id_[at]; }
  bool in_sheet(std::size_t at) const { return in_sheet_[at]; }

 private:
  void copy(std::size_t from, std::size_t to) {
    rows_.copy(from, to);
    id_[to] = id_[from];
    extent_[to] = extent_[from];
    in_sheet_[to] = in_sheet_[from];
    squared_[to] = squared_[from];
  }

  std::size_t size_ = 0;
  TriangleRows<kMost> rows_;
  std::uint64_t id_[kMost];
  float extent_[kMost];
  bool in_sheet_[kMost];
  float squared_[kMost];
};

}  // namespace planetree::octree
