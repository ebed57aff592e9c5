#pragma once

#include <cstddef>
#include <cstdint>

#include "octree/frame.h"
#include "octree/triangle_distance.h"

namespace planetree::octree {

/// A triangle block in its frame, read back exactly.
class BlockView {
 public:
  BlockView(const std::byte* record, const BlockShape& shape)
      : header_(*reinterpret_cast<const BlockHeader*>(record)), shape_(shape) {}

  const BlockHeader& header() const { return header_; }
  unsigned triangle_count() const { return header_.triangle_count; }

  Point vertex(unsigned index) const {
    const unsigned stride = header_.stride;
    if (shape_.float64) {
      const auto* exact = at<double>(shape_.exact_offset(stride));
      return {exact[index], exact[stride + index], exact[2 * stride + index]};
    }
    const auto* local = at<float>(kSlotBytes);
    return {local[index], local[stride + index], local[2 * stride + index]};
  }

  /// The exact vertices, header().stride of each coordinate; null where they are no floats.
  const float* float_vertices() const { return shape_.float64 ? nullptr : at<float>(kSlotBytes); }

  Triangle triangle(unsigned index) const {
    return {vertex(header_.corner[0][index]), vertex(header_.corner[1][index]),
            vertex(header_.corner[2][index])};
  }

  std::uint64_t id(unsigned index) const {
    const std::size_t offset = shape_.id_offset(header_.stride);
    return shape_.wide_ids ? at<std::uint64_t>(offset)[index] : at<std::uint32_t>(offset)[index];
  }

 private:
  template <class T>
  const T* at(std::size_t offset) const {
    return reinterpret_cast<const T*>(reinterpret_cast<const std::byte*>(&header_) + offset);
  }

  const BlockHeader& header_;
  const BlockShape& shape_;
};

}  // namespace planetree::octree
