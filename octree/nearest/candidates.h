#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/geometry/triangle_rows.h"

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
