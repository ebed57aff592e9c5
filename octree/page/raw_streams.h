#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "octree/page/frame.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {

/// A byte-shuffled array: byte k of element i is at [k * count + i].
template <class T>
class Shuffled {
 public:
  Shuffled() = default;
  Shuffled(const std::byte* bytes, std::size_t count) : bytes_(bytes), count_(count) {}
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

/// The streams of one page's raw bytes, cut and length-checked but not yet
/// believed: only their sizes are known to be right.
struct RawStreams {
  PageHead head{};
  Shuffled<float> root_boxes;
  Shuffled<std::uint8_t> child_counts, heights;
  Shuffled<std::uint16_t> child_kinds;
  Shuffled<std::uint8_t> child_boxes;  ///< 6 planes of child_count
  Shuffled<std::int16_t> child_normals, child_slabs;
  Shuffled<std::uint16_t> child_radii;
  Shuffled<std::int16_t> child_vectors;  ///< 3 planes of child_count, or none
  Shuffled<std::int8_t> child_firsts;    ///< 5 planes
  Shuffled<std::uint16_t> child_areas, child_seconds;
  Shuffled<std::uint32_t> page_links;
  Shuffled<std::uint8_t> triangle_counts;  ///< with kSheetBit, kCompactBit
  Shuffled<std::uint8_t> vertex_counts, new_counts;
  Shuffled<std::uint16_t> vertex_refs;
  std::span<const std::byte> corners;
  Shuffled<float> vertices32;
  Shuffled<double> vertices64;
  Shuffled<std::uint32_t> first_ids32, id_steps32;
  Shuffled<std::uint64_t> first_ids64, id_steps64;

  std::uint8_t triangle_count(std::size_t block) const {
    return triangle_counts[block] & kCountBits;
  }
  bool in_sheet(std::size_t block) const { return (triangle_counts[block] & kSheetBit) != 0; }
  bool compact(std::size_t block) const { return (triangle_counts[block] & kCompactBit) != 0; }

  /// Cuts `raw`. Returns null, or what is wrong.
  const char* cut(std::span<const std::byte> raw, const BlockShape& shape) noexcept;
};

}  // namespace planetree::octree
