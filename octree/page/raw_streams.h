#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "octree/page/frame.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {

/// View of a byte-stream split array: byte k of element i is at [k * count + i].
template <class T>
class ByteSplit {
 public:
  ByteSplit() = default;
  ByteSplit(const std::byte* bytes, std::size_t count) : bytes_(bytes), count_(count) {}
  static constexpr std::size_t bytes_for(std::size_t count) { return count * sizeof(T); }
  std::size_t size() const { return count_; }
  const std::byte* bytes() const { return bytes_; }

  T operator[](std::size_t index) const {
    using Bits = std::conditional_t<
        sizeof(T) == 8, std::uint64_t,
        std::conditional_t<sizeof(T) == 4, std::uint32_t,
                           std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;
    Bits bits = 0;
#pragma GCC unroll 8
    for (std::size_t k = 0; k < sizeof(T); ++k)
      bits = static_cast<Bits>(bits | static_cast<Bits>(bytes_[k * count_ + index]) << (8 * k));
    T value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

 private:
  const std::byte* bytes_ = nullptr;
  std::size_t count_ = 0;
};

/// The streams of a distance page. Their lengths have been checked, their contents have not.
struct RawStreams {
  PageHead head{};
  ByteSplit<float> root_boxes;
  ByteSplit<std::uint8_t> child_counts, heights;
  ByteSplit<std::uint16_t> child_kinds;
  ByteSplit<std::uint8_t> child_boxes;  ///< 6 planes of child_count
  ByteSplit<std::int16_t> child_normals, child_slabs;
  ByteSplit<std::uint16_t> child_radii;
  ByteSplit<std::int16_t> child_dipoles;     ///< 3 planes of child_count, or none
  ByteSplit<std::int8_t> child_quadrupoles;  ///< 5 planes
  ByteSplit<std::uint16_t> child_areas, child_second_moments;
  ByteSplit<std::uint32_t> page_links;
  ByteSplit<std::uint8_t> triangle_counts;  ///< with kHeightFieldBit, kCompactBit
  ByteSplit<std::uint8_t> vertex_counts, new_counts;
  ByteSplit<std::uint16_t> vertex_refs;
  std::span<const std::byte> corners;
  ByteSplit<float> vertices32;
  ByteSplit<double> vertices64;
  ByteSplit<std::uint32_t> first_ids32, id_steps32;
  ByteSplit<std::uint64_t> first_ids64, id_steps64;

  std::uint8_t triangle_count(std::size_t block) const {
    return triangle_counts[block] & kCountBits;
  }
  bool is_height_field(std::size_t block) const {
    return (triangle_counts[block] & kHeightFieldBit) != 0;
  }
  bool compact(std::size_t block) const { return (triangle_counts[block] & kCompactBit) != 0; }

  /// Locates the streams in `raw`, which must outlive this object. Returns null, or a fault.
  const char* read(std::span<const std::byte> raw, const BlockShape& shape) noexcept;
};

}  // namespace planetree::octree
