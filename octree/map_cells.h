#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "octree/map_record.h"

namespace planetree::octree {

/// The cells of a ColourMap, by their numbers: the colour of each, and of what is below the grey
/// ones. All pointers are into the map's memory.
struct MapCells {
  static constexpr int kUnknown = MapRecord::kUnknown;

  enum Code : unsigned {
    kWhite = 0,
    kInside = 1,  ///< of the sign `inside`
    kListed,      ///< grey
    kOther,       ///< nothing is known here
  };
  /// The codes of some cells, a bit of each in either word.
  struct Stretch {
    static constexpr unsigned kCells = 32;
    std::uint32_t low, high;
    std::uint32_t listed_before;  ///< cells, in all before these
  };
  static constexpr Stretch kUnpainted{~std::uint32_t{0}, ~std::uint32_t{0}, 0};

  /// Listed cells that follow each other, by the colours of their octants: `inside` are those of
  /// its sign.
  struct Group {
    static constexpr unsigned kCells = 8;
    std::uint64_t unknown, inside;
    std::uint64_t first_record;  ///< of the unknown ones, in their order
  };

  Stretch* stretches = nullptr;
  Group* groups = nullptr;
  MapRecord* records = nullptr;
  int inside = 1;  ///< or -1

  static constexpr std::size_t stretches_for(std::uint64_t cells) {
    return static_cast<std::size_t>((cells + Stretch::kCells - 1) / Stretch::kCells);
  }

  unsigned code_of(std::size_t cell) const {
    const Stretch& stretch = stretches[cell / Stretch::kCells];
    const std::size_t at = cell % Stretch::kCells;
    return (stretch.low >> at & 1) | (stretch.high >> at & 1) << 1;
  }
  void set(std::size_t cell, Code code) {
    Stretch& stretch = stretches[cell / Stretch::kCells];
    const std::uint32_t bit = std::uint32_t{1} << cell % Stretch::kCells;
    stretch.low = (code & 1) != 0 ? stretch.low | bit : stretch.low & ~bit;
    stretch.high = (code & 2) != 0 ? stretch.high | bit : stretch.high & ~bit;
  }
  /// Counts the cells listed before each stretch. Returns how many there are in all.
  std::size_t count_listed(std::size_t stretch_count) {
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < stretch_count; ++i) {
      stretches[i].listed_before = before;
      before += count(listed_in(stretches[i]));
    }
    return before;
  }
  static constexpr std::size_t groups_for(std::size_t listed) {
    return (listed + Group::kCells - 1) / Group::kCells;
  }
  /// Makes all octants unknown.
  void clear_groups(std::size_t listed) {
    for (std::size_t i = 0; i < groups_for(listed); ++i) {
      const std::size_t octants = 8 * std::min<std::size_t>(listed - Group::kCells * i, 8);
      std::construct_at(&groups[i], Group{~std::uint64_t{0} >> (64 - octants), 0, 0});
    }
  }
  /// Counts the records before each group. Returns how many there are in all.
  std::size_t count_records(std::size_t group_count) {
    std::size_t before = 0;
    for (std::size_t i = 0; i < group_count; ++i) {
      groups[i].first_record = before;
      before += count(groups[i].unknown);
    }
    return before;
  }

  /// An octant of a listed cell.
  struct Octant {
    Group& group;
    std::uint64_t bit;

    bool is_unknown() const { return (group.unknown & bit) != 0; }
    bool is_inside() const { return (group.inside & bit) != 0; }
    std::uint64_t record() const { return group.first_record + count(group.unknown & (bit - 1)); }
  };
  Octant octant_of(std::size_t cell, unsigned octant) const {
    const Stretch& stretch = stretches[cell / Stretch::kCells];
    const std::uint32_t before = (std::uint32_t{1} << cell % Stretch::kCells) - 1;
    const std::uint32_t number = stretch.listed_before + count(listed_in(stretch) & before);
    return {groups[number / Group::kCells],
            std::uint64_t{1} << (8 * (number % Group::kCells) + octant)};
  }

  /// What is known of a place.
  struct Found {
    int winding;                        ///< its sign, or kUnknown
    const MapRecord* record = nullptr;  ///< then: of the octant; null if the cell is not listed
  };
  /// In a cell that has a code and is not listed.
  Found find_by_code(unsigned code) const {
    // By no branch: points come from either side.
    return {code <= kInside ? static_cast<int>(code) * inside : kUnknown};
  }
  /// In a listed cell, in octant `part` of its octant `octant`.
  Found find_below(std::size_t cell, unsigned octant, unsigned part) const {
    const Found found = find_below(cell, octant);
    return found.record ? Found{found.record->winding(part), found.record} : found;
  }
  /// The same as far as it takes no look at a record.
  Found find_below(std::size_t cell, unsigned octant) const {
    const Octant found = octant_of(cell, octant);
    if (!found.is_unknown()) return {static_cast<int>(found.is_inside()) * inside};
    return {kUnknown, &records[found.record()]};
  }

 private:
  static constexpr std::uint32_t listed_in(const Stretch& stretch) {
    return stretch.high & ~stretch.low;
  }
  // The processors we build for may lack an instruction for it.
  static constexpr std::uint32_t count(std::uint64_t set) {
    set -= set >> 1 & 0x5555555555555555;
    set = (set & 0x3333333333333333) + (set >> 2 & 0x3333333333333333);
    set = (set + (set >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return static_cast<std::uint32_t>(set * 0x0101010101010101 >> 56);
  }
};

}  // namespace planetree::octree
