#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/frame.h"

namespace planetree::octree {

/// Read access to a triangle block in its frame. Vertices and indices are exact.
class BlockView {
 public:
  BlockView(const std::byte* record, const BlockShape& shape)
      : BlockView(*reinterpret_cast<const BlockHeader*>(record), shape) {}
  /// The rest of the block follows `header` in memory.
  BlockView(const BlockHeader& header, const BlockShape& shape) : header_(header), shape_(shape) {}

  const BlockHeader& header() const { return header_; }
  /// Returns the number of slots that the record takes.
  unsigned slots() const { return shape_.slots(header_.vertex_count(), header_.compact()); }
  unsigned triangle_count() const { return header_.triangle_count; }

  Point vertex(unsigned index) const {
    return shape_.float64 ? vertex_of(exact_vertices(), index)
                          : vertex_of(at<float>(kSlotBytes), index);
  }

  /// Returns the exact vertices, header().stride() of each coordinate; null in float64 models.
  const float* float_vertices() const { return shape_.float64 ? nullptr : at<float>(kSlotBytes); }

  Triangle triangle(unsigned index) const {
    return shape_.float64 ? triangle_of(exact_vertices(), index)
                          : triangle_of(at<float>(kSlotBytes), index);
  }

  std::uint64_t id(unsigned index) const {
    if (header_.compact()) return header_.first_id + (index > 0 ? header_.id_step[index - 1] : 0U);
    const std::size_t offset = shape_.id_offset(header_.stride());
    return shape_.wide_ids ? at<std::uint64_t>(offset)[index] : at<std::uint32_t>(offset)[index];
  }

 private:
  const double* exact_vertices() const { return at<double>(shape_.exact_offset(header_.stride())); }

  template <class T>
  Point vertex_of(const T* rows, unsigned index) const {
    const unsigned stride = header_.stride();
    return {rows[index], rows[stride + index], rows[2 * stride + index]};
  }
  template <class T>
  Triangle triangle_of(const T* rows, unsigned index) const {
    const auto corners = header_.corners(index);
    return {vertex_of(rows, corners[0]), vertex_of(rows, corners[1]), vertex_of(rows, corners[2])};
  }
  template <class T>
  const T* at(std::size_t offset) const {
    return reinterpret_cast<const T*>(reinterpret_cast<const std::byte*>(&header_) + offset);
  }

  const BlockHeader& header_;
  const BlockShape& shape_;
};

}  // namespace planetree::octree
