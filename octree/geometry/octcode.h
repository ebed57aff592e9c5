#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

/// Octcodes: 64-bit names of octree cells.
///
///     63     59 58                                     2 1      0
///     [ level ][ Morton code, left-aligned, 57 bits     ][ within ]
///
/// In the order of their integers, coarse cells come first, cells of one level are in Morton order,
/// and a cell precedes every cell inside it.
///
/// source  "Out-of-core real-time haptic interaction on very large models", section 3.1: 57 bits of
///         Morton code and 5 bits of level. The last 2 bits are our own: they count the one-bit
///         splits within a level, so that every prefix of a Morton code has an octcode.
namespace planetree::octree {

inline constexpr unsigned kLevels = 19;
inline constexpr unsigned kMortonBits = 3 * kLevels;

/// Spreads the low 19 bits of `value` to every third bit.
constexpr std::uint64_t spread_bits(std::uint64_t value) {
  value &= 0x7ffff;
  value = (value | value << 32) & 0x1f00000000ffff;
  value = (value | value << 16) & 0x1f0000ff0000ff;
  value = (value | value << 8) & 0x100f00f00f00f00f;
  value = (value | value << 4) & 0x10c30c30c30c30c3;
  return (value | value << 2) & 0x1249249249249249;
}

/// Gathers every third bit of `code` into the low 19 bits.
constexpr std::uint32_t gather_bits(std::uint64_t code) {
  code &= 0x1249249249249249;
  code = (code | code >> 2) & 0x10c30c30c30c30c3;
  code = (code | code >> 4) & 0x100f00f00f00f00f;
  code = (code | code >> 8) & 0x1f0000ff0000ff;
  code = (code | code >> 16) & 0x1f00000000ffff;
  return static_cast<std::uint32_t>((code | code >> 32) & 0x7ffff);
}

/// Returns the Morton code of a finest cell. Each coordinate is below 2^19. Bit 0 of every triple
/// of bits is x, bit 1 y, bit 2 z.
constexpr std::uint64_t morton_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

/// Returns the octcode of the first `prefix_bits` (0 to 57) bits of a Morton code.
constexpr std::uint64_t octcode_of_prefix(std::uint64_t morton, unsigned prefix_bits) {
  const unsigned dropped = kMortonBits - prefix_bits;
  const std::uint64_t code = dropped == kMortonBits ? 0 : morton >> dropped << dropped;
  return std::uint64_t{prefix_bits / 3} << 59 | code << 2 | prefix_bits % 3;
}

/// Returns the octcode of the smallest cell that contains two Morton codes and therefore all
/// between them.
constexpr std::uint64_t octcode_of_range(std::uint64_t least, std::uint64_t greatest) {
  const auto same = static_cast<unsigned>(std::countl_zero(least ^ greatest)) - (64 - kMortonBits);
  return octcode_of_prefix(least, std::min(same, kMortonBits));
}

/// Returns the Morton code of the first finest cell in an octcode's cell.
constexpr std::uint64_t morton_of_octcode(std::uint64_t octcode) { return octcode << 5 >> 7; }

/// A cell decoded from an octcode. `x`, `y` and `z` count cells of its level.
struct Cell {
  unsigned level = 0;
  unsigned within = 0;  ///< one-bit splits below `level`, 0 to 2
  std::uint32_t x = 0, y = 0, z = 0;
};

constexpr Cell cell_of_octcode(std::uint64_t octcode) {
  Cell cell;
  cell.level = static_cast<unsigned>(octcode >> 59);
  cell.within = static_cast<unsigned>(octcode & 3);
  const std::uint64_t morton = morton_of_octcode(octcode);
  const unsigned shift = cell.level > kLevels ? 0 : kLevels - cell.level;
  cell.x = gather_bits(morton) >> shift;
  cell.y = gather_bits(morton >> 1) >> shift;
  cell.z = gather_bits(morton >> 2) >> shift;
  return cell;
}

}  // namespace planetree::octree
