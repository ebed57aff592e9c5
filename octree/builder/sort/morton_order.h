#pragma once

#include <cstdint>
#include <vector>

#include "octree/builder/sort/triangles.h"
#include "octree/geometry/octcode.h"

namespace planetree::octree {

/// Bit above the Morton code in the code of a stray triangle, so that strays come after the core.
inline constexpr std::uint64_t kStrayCode = std::uint64_t{1} << kMortonBits;

/// Bit in the index of a cap where caps are among triangles of the surface.
inline constexpr std::uint64_t kCapIndex = std::uint64_t{1} << 63;
constexpr bool is_cap(std::uint64_t index) { return (index & kCapIndex) != 0; }

/// Returns the Morton code in the code of a triangle.
constexpr std::uint64_t morton_part(std::uint64_t code) { return code & (kStrayCode - 1); }
constexpr bool is_stray(std::uint64_t code) { return (code & kStrayCode) != 0; }

/// Morton code and position of a triangle. The code is that of the finest octree cell that holds
/// the centre of the triangle's box.
struct MortonKey {
  std::uint64_t code;      ///< without kStrayCode
  std::uint32_t position;  ///< in the Triangles it belongs to
};

/// Morton code of the finest cell with the centre of a triangle's box. The root cell is the cube of
/// side 2 at the least corner of the core, so that it holds every such centre but those of strays.
/// Of these, the code is that of the nearest finest cell by axis.
/// lower  least corner of the core.
std::uint64_t morton_code_of(const Triangle& triangle, const Point& lower);

/// The keys of triangles that are sorted.
std::vector<MortonKey> keys_of(const Triangles& sorted);

}  // namespace planetree::octree
