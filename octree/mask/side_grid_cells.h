#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "octree/geometry/cell_slab.h"
#include "octree/page/mask_frame.h"

namespace planetree::octree {

/// What a SideGrid has of a grey cell of a mask: a copy of a node, the link to a leaf, or the link
/// to a leaf's list of blocks and the leaf's slab. A record has no room for links beyond 32 bits,
/// so that it has nothing of cells in the last pages of very large masks. It does not straddle
/// cache lines.
struct alignas(16) SideGridRecord {
  static constexpr int kUnknown = 2;  ///< no sign of a winding number

  std::uint32_t link = 0;                  ///< to a node's family, a leaf's record, or its list
  std::uint32_t slab = CellSlab{}.word();  ///< slab of a listed leaf
  std::uint8_t grey = 0;                   ///< of a node, as in MaskNode; 0 in other records
  std::uint8_t kind = kNothing;            ///< not of a node: a kind and flags
  std::uint8_t black = 0;                  ///< MaskNode::leaf_or_black; of a list: count of blocks
  std::uint8_t inverted = 0;               ///< as in MaskNode; of a list: MaskListed::higher
  std::uint8_t touched = 0xff;             ///< octants of this cell that listed blocks touch

  static constexpr SideGridRecord of_node(const MaskNode& node) {
    if (node.family_high != 0) return {};
    return {.link = node.family_low,
            .grey = node.grey,
            .kind = kOneColour,
            .black = node.leaf_or_black,
            .inverted = node.inverted};
  }
  /// Makes the record of a cell of one colour.
  static constexpr SideGridRecord of_colour(int winding) {
    MaskNode node{};
    (winding < 0 ? node.inverted : node.leaf_or_black) = winding != 0 ? 0xff : 0;
    return of_node(node);
  }
  /// Makes the record of a leaf that is not listed.
  ///
  /// levels_above  levels from this cell up to the leaf's cell, 0 to 7
  static constexpr SideGridRecord of_leaf(MaskLink link, unsigned levels_above) {
    if (!has(link)) return {};
    return {.link = static_cast<std::uint32_t>(link),
            .kind = static_cast<std::uint8_t>(kLeaf | levels_above)};
  }
  /// Makes the record of a listed leaf for which has() is true. Its list is at `link`.
  ///
  /// touched       octants of the leaf that listed blocks touch; used if levels_above is 0
  /// levels_above  as in of_leaf()
  static constexpr SideGridRecord of_list(const MaskListed& listed, MaskLink link,
                                          const CellSlab& slab, unsigned touched,
                                          unsigned levels_above) {
    if (!has(link)) return {};
    const unsigned least = listed.least == 0 ? 0 : kMinIsMinus1;
    return {.link = static_cast<std::uint32_t>(link),
            .slab = slab.word(),
            .kind = static_cast<std::uint8_t>(kListed | least | levels_above),
            .black = listed.block_count,
            .inverted = listed.higher,
            .touched = static_cast<std::uint8_t>(levels_above == 0 ? touched : 0xff)};
  }
  /// Whether a record can hold the corner numbers of a listed leaf.
  static constexpr bool has(const MaskListed& listed) {
    return listed.least == 0 || listed.least == -1;
  }

  constexpr bool is_node() const { return grey != 0; }
  constexpr bool is_leaf() const { return grey == 0 && (kind & kLeaf) != 0; }
  constexpr bool is_listed() const { return grey == 0 && (kind & kListed) != 0; }
  constexpr bool is_nothing() const { return grey == 0 && kind == kNothing; }
  constexpr unsigned levels_above() const { return grey != 0 ? 0 : kind & kLevelsAbove; }
  /// The node as the mask has it.
  constexpr MaskNode node() const { return {link, 0, grey, black, inverted}; }
  /// The listed leaf as the mask has it, with a list that starts at `slot`.
  constexpr MaskListed listed(std::uint32_t slot) const {
    return {kListedTag, black, static_cast<std::int8_t>((kind & kMinIsMinus1) != 0 ? -1 : 0),
            inverted, slot};
  }
  /// The sign of the winding number in an octant of this cell; kUnknown where it is grey.
  constexpr int winding(unsigned octant) const {
    if (is_listed())
      return (touched >> octant & 1) != 0 ? kUnknown : corner_number(listed(0), octant);
    const bool certain = grey != 0 ? (grey >> octant & 1) == 0 : kind == kOneColour;
    return certain ? (black >> octant & 1) - (inverted >> octant & 1) : kUnknown;
  }

 private:
  static constexpr bool has(MaskLink link) { return link >> 32 == 0; }

  static constexpr std::uint8_t kOneColour = 0, kLeaf = 0x80, kListed = 0x40, kMinIsMinus1 = 0x20,
                                kNothing = 0x10, kLevelsAbove = 7;
};
static_assert(sizeof(SideGridRecord) == 16);

/// The cells of a SideGrid: the colour of each, and the colours of the octants of grey ones. Cells
/// are stored in bricks of 4 x 4 x 4, which have numbers. What is known about the cells of a brick
/// lies together, because a lookup seldom needs other bricks. All pointers are into the grid's
/// memory.
struct SideGridCells {
  static constexpr int kUnknown = SideGridRecord::kUnknown;

  enum Code : unsigned {
    kWhite = 0,
    kInside = 1,  ///< inside, with a winding number of the sign `inside`
    kListed,      ///< grey
    kOther,       ///< unknown
  };
  /// A cell: the number of its brick, and its index there. Bits 3 to 5 of the index are the upper
  /// halves of the brick in x, y and z, bits 0 to 2 the upper halves of those halves.
  struct Cell {
    std::size_t brick;
    unsigned at;
  };
  static constexpr unsigned kBrickBits = 2;  ///< log2 of the cells along a brick's side

  /// The codes of a brick's cells: their lower bits in one word, their upper bits in the other.
  struct Codes {
    std::uint64_t low, high;

    constexpr Code of(unsigned at) const {
      return static_cast<Code>((low >> at & 1) | (high >> at & 1) << 1);
    }
    void set(unsigned at, Code code) {
      const std::uint64_t bit = std::uint64_t{1} << at;
      low = (code & 1) != 0 ? low | bit : low & ~bit;
      high = (code & 2) != 0 ? high | bit : high & ~bit;
    }
    constexpr std::uint64_t listed() const { return high & ~low; }
    bool operator==(const Codes&) const = default;
  };
  static constexpr std::uint64_t kAll = ~std::uint64_t{0};
  static constexpr Codes kUnfilled{kAll, kAll};

  /// Up to kCells consecutive listed cells of a brick, with a bit for each of their octants:
  /// whether its colour is unknown, and whether it is inside.
  struct Group {
    static constexpr unsigned kCells = 8;
    std::uint64_t unknown, inside;
    std::uint64_t first_record;  ///< index of the first unknown octant's record; others follow
  };

  std::uint32_t* first_word = nullptr;  ///< index into `words` of each brick
  std::uint64_t* words = nullptr;       ///< of each brick its Codes, then its groups
  SideGridRecord* records = nullptr;
  int inside = 1;  ///< sign of the winding number in inside cells: 1 or -1

  static constexpr std::size_t groups_in(const Codes& codes) {
    return (count(codes.listed()) + Group::kCells - 1) / Group::kCells;
  }

  /// Writes the words of bricks with these codes. All octants of listed cells become unknown.
  /// Bricks of one colour share their words. Returns the number of words; if it is above
  /// `capacity`, some did not fit.
  std::size_t lay_out(std::span<const Codes> bricks, std::size_t capacity) {
    constexpr std::array kShared{Codes{0, 0}, Codes{kAll, 0}, kUnfilled};
    constexpr std::size_t kCodeWords = sizeof(Codes) / sizeof(std::uint64_t);
    std::size_t size = 0;
    for (const Codes& codes : kShared) size = add_brick(size, codes, capacity);
    for (std::size_t brick = 0; brick < bricks.size() && size <= capacity; ++brick) {
      const auto shared = static_cast<std::size_t>(
          std::find(kShared.begin(), kShared.end(), bricks[brick]) - kShared.begin());
      const bool shares = shared < kShared.size();
      first_word[brick] = static_cast<std::uint32_t>(shares ? kCodeWords * shared : size);
      if (!shares) size = add_brick(size, bricks[brick], capacity);
    }
    return size;
  }
  /// Sets first_record of each group. Returns the number of records.
  std::size_t count_records(std::size_t brick_count) {
    std::size_t before = 0;
    for (std::size_t brick = 0; brick < brick_count; ++brick)
      for (std::size_t i = 0; i < groups_in(codes_of(brick)); ++i) {
        Group& next = group(first_word[brick], i);
        next.first_record = before;
        before += count(next.unknown);
      }
    return before;
  }

  const Codes& codes_of(std::size_t brick) const {
    return *reinterpret_cast<const Codes*>(words + first_word[brick]);
  }
  /// Returns the code of a cell. Also prefetches the kLines cache lines after that of the codes,
  /// where the groups of listed cells are. One line holds the first two groups or more, three hold
  /// nearly all.
  template <std::size_t kLines = 0>
  Code code_of(Cell cell) const {
    const Codes& codes = codes_of(cell.brick);
    for (std::size_t line = 1; line <= kLines; ++line)
      __builtin_prefetch(reinterpret_cast<const std::byte*>(&codes) + line * kLineBytes);
    return codes.of(cell.at);
  }

  /// An octant of a listed cell.
  struct Octant {
    Group& group;
    std::uint64_t bit;

    bool is_unknown() const { return (group.unknown & bit) != 0; }
    bool is_inside() const { return (group.inside & bit) != 0; }
    std::uint64_t record() const { return group.first_record + count(group.unknown & (bit - 1)); }
  };
  Octant octant_of(Cell cell, unsigned octant) const {
    const std::uint64_t before = (std::uint64_t{1} << cell.at) - 1;
    const unsigned number = count(codes_of(cell.brick).listed() & before);
    return {group(first_word[cell.brick], number / Group::kCells),
            std::uint64_t{1} << (8 * (number % Group::kCells) + octant)};
  }

  /// What is known about a position.
  struct Found {
    int winding;  ///< sign of the winding number, or kUnknown
    /// If that is unknown: record of the octant, or null if the cell is not listed.
    const SideGridRecord* record = nullptr;
  };
  /// Finds by the code of a cell that is not listed.
  Found find_by_code(unsigned code) const {
    // The colour selects no branch: points come from either side, which is not predictable.
    return {code <= kInside ? static_cast<int>(code) * inside : kUnknown};
  }
  /// Finds in octant `part` of octant `octant` of a listed cell.
  Found find_below(Cell cell, unsigned octant, unsigned part) const {
    const Found found = find_below(cell, octant);
    return found.record ? Found{found.record->winding(part), found.record} : found;
  }
  /// Finds in an octant of a listed cell, without reading a record.
  Found find_below(Cell cell, unsigned octant) const {
    const Octant found = octant_of(cell, octant);
    if (!found.is_unknown()) return {static_cast<int>(found.is_inside()) * inside};
    return {kUnknown, &records[found.record()]};
  }

 private:
  static constexpr std::size_t kLineBytes = 64;
  static constexpr std::size_t kGroupWords = sizeof(Group) / sizeof(std::uint64_t);

  // Appends a brick to `size` words. Returns how many words there are then; capacity + 1 if it does
  // not fit.
  std::size_t add_brick(std::size_t size, const Codes& codes, std::size_t capacity) {
    const std::size_t groups = groups_in(codes), end = size + 2 + kGroupWords * groups;
    if (end > capacity) return capacity + 1;
    std::construct_at(reinterpret_cast<Codes*>(words + size), codes);
    std::size_t octants = 8 * std::size_t{count(codes.listed())};
    for (std::size_t i = 0; i < groups; ++i, octants -= 64)
      std::construct_at(&group(size, i),
                        Group{octants >= 64 ? kAll : (std::uint64_t{1} << octants) - 1, 0, 0});
    return end;
  }
  Group& group(std::size_t first, std::size_t number) const {
    return *reinterpret_cast<Group*>(words + first + 2 + kGroupWords * number);
  }
  // Number of bits set. The processors that planetree is built for may lack an instruction for it.
  static constexpr std::uint32_t count(std::uint64_t set) {
    set -= set >> 1 & 0x5555555555555555;
    set = (set & 0x3333333333333333) + (set >> 2 & 0x3333333333333333);
    set = (set + (set >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return static_cast<std::uint32_t>(set * 0x0101010101010101 >> 56);
  }
};

}  // namespace planetree::octree
