#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/cell_grid.h"
#include "octree/mask_frame.h"
#include "octree/mask_lookup.h"
#include "octree/tree_view.h"

namespace planetree::octree {

/// A mask's cells of one level side by side, with a rim of white ones about the model's box: one
/// look tells the side of most points, and needs no page. The mask's records of the grey ones
/// are there too, so that a lookup need not begin at the root. Filled once; then any thread may
/// look.
class ColourMap {
 public:
  /// Memory of the map of a model of so many triangles.
  static constexpr std::size_t bytes(std::uint64_t triangles) {
    constexpr std::uint64_t kFewestBytes = 64, kMostBytes = std::uint64_t{1} << 18;
    return std::clamp(triangles / 4, kFewestBytes, kMostBytes);
  }

  /// A map that knows nothing.
  ColourMap() = default;

  /// Of a mask's first pages, as far as they can be had.
  ///
  /// memory  where the map is to be, on a boundary of 4 bytes; must outlive this.
  void fill(const MaskFacts& mask, const TreeFacts& tree, PageReader pages,
            std::span<std::byte> memory) noexcept;

  /// The sign of a point's winding number, where its cell is white or black; else kUnknown.
  int winding(const Point& point) const noexcept {
    std::array<std::uint32_t, 3> at;
    if (!find(point, at)) return kUnknown;
    const std::size_t cell = number(at);
    const unsigned code = code_of(cell);
    // By no branch: points come from either side.
    if (code <= kInside) return static_cast<int>(code) * inside_;
    if (code == kOther) return kUnknown;
    const MaskNode& record = record_of(cell);
    return record.grey != 0 ? winding_below(record, point, at) : kUnknown;
  }

  static constexpr int kUnknown = 2;

  /// A grey cell and its record in the mask.
  struct Spot {
    GridCell cell;
    const MaskNode* record = nullptr;  ///< null where the map has none
  };
  /// That of a point.
  Spot spot(const Point& point) const noexcept {
    std::array<std::uint32_t, 3> at;
    if (!find(point, at)) return {};
    const std::size_t number = this->number(at);
    if (code_of(number) != kListed) return {};
    const MaskNode& record = record_of(number);
    const GridCell cell{level_, {at[0] - kRim, at[1] - kRim, at[2] - kRim}};
    if (is_leaf(record)) return {cell.ancestor(level_ - record.black), &record};
    return {cell, record.grey != 0 ? &record : nullptr};
  }

  /// No node is stored so: a leaf whose corners have numbers of four bits, in `family`; it may
  /// be of a level above, `black` ones.
  static constexpr bool is_leaf(const MaskNode& record) {
    return record.grey == 0 && record.leaf == kLeafTag;
  }
  static constexpr MaskCorners corners_of(const MaskNode& leaf) {
    MaskCorners corners{};
    for (unsigned i = 0; i < 8; ++i)
      corners[i] = static_cast<std::int8_t>(static_cast<int>(leaf.family >> 4 * i & 15) - 8);
    return corners;
  }

 private:
  class Painter;

  enum Code : unsigned {
    kWhite = 0,
    kInside = 1,  ///< of the sign `inside_`
    kListed,      ///< grey, with a record
    kOther,       ///< nothing is known here
  };
  static constexpr std::uint8_t kLeafTag = 0xff;
  static constexpr std::uint32_t kRim = 1;  ///< cells before, and behind, those of the box

  /// Some cells, and the number of the first record of those that are listed.
  struct Stretch {
    static constexpr unsigned kCells = 48;
    std::uint32_t first_record;
    std::uint32_t codes[3];  ///< two bits a cell
  };
  static_assert(sizeof(Stretch) == 16 && sizeof(Stretch) % alignof(MaskNode) == 0);
  static constexpr Stretch kUnpainted{0, {~0U, ~0U, ~0U}};

  static constexpr std::size_t stretches_for(std::uint64_t cells) {
    return static_cast<std::size_t>((cells + Stretch::kCells - 1) / Stretch::kCells);
  }

  // Which of the map's cells the point is in. False where rounding does not tell that cell for
  // certain, and where the map knows nothing.
  bool find(const Point& point, std::array<std::uint32_t, 3>& at) const {
    double from_middle = 0;
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double place = (point[axis] - lower_[axis]) * cells_per_unit_ + kRim;
      // What is no number is in the rim.
      const double clamped = std::min(std::max(0.5, place), last_middle_[axis]);
      const auto whole = static_cast<std::int32_t>(clamped);
      at[axis] = static_cast<std::uint32_t>(whole);
      from_middle = std::max(from_middle, std::fabs(clamped - 0.5 - whole));
    }
    return from_middle < certain_ || find_among_sides(point, at);
  }
  // As rounded, sides may be elsewhere than the product says.
  bool find_among_sides(const Point& point, const std::array<std::uint32_t, 3>& at) const {
    for (unsigned axis = 0; axis < 3; ++axis) {
      if (at[axis] < kRim || at[axis] + kRim >= width_[axis]) return false;
      if (!(side(axis, at[axis]) <= point[axis] && point[axis] < side(axis, at[axis] + 1)))
        return false;
    }
    return true;
  }
  std::size_t number(const std::array<std::uint32_t, 3>& at) const {
    return (std::size_t{at[2]} * width_[1] + at[1]) * width_[0] + at[0];
  }
  unsigned code_of(std::size_t cell) const {
    const auto at = static_cast<unsigned>(cell % Stretch::kCells);
    return stretches_[cell / Stretch::kCells].codes[at / 16] >> 2 * (at % 16) & 3;
  }
  const MaskNode& record_of(std::size_t cell) const { return records_[record_number(cell)]; }
  // Of a listed cell: as many are listed before it.
  std::uint32_t record_number(std::size_t cell) const {
    const Stretch& stretch = stretches_[cell / Stretch::kCells];
    const auto at = static_cast<unsigned>(cell % Stretch::kCells);
    std::uint32_t record = stretch.first_record;
    for (unsigned i = 0; i < at / 16; ++i) record += listed(stretch.codes[i]);
    return record + listed(stretch.codes[at / 16] & ((1U << 2 * (at % 16)) - 1));
  }
  static constexpr unsigned listed(std::uint32_t codes) {
    std::uint32_t set = codes >> 1 & ~codes & 0x55555555;
    set = (set & 0x33333333) + (set >> 2 & 0x33333333);
    set = (set + (set >> 4)) & 0x0f0f0f0f;
    return set * 0x01010101 >> 24;
  }
  // Of the half as large cell that the point is in.
  int winding_below(const MaskNode& node, const Point& point,
                    const std::array<std::uint32_t, 3>& at) const {
    unsigned octant = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double middle =
          lower_[axis] + cell_side_ / 2 * static_cast<double>(2 * (at[axis] - kRim) + 1);
      octant |= static_cast<unsigned>(middle <= point[axis]) << axis;
    }
    if ((node.grey >> octant & 1) != 0) return kUnknown;
    return (node.black >> octant & 1) - (node.inverted >> octant & 1);
  }
  // As CellGrid's.
  double side(unsigned axis, std::uint32_t at) const {
    return lower_[axis] + cell_side_ * static_cast<double>(at - kRim);
  }

  Point lower_ = Point::Zero();
  double cell_side_ = 0;
  double cells_per_unit_ = 0;
  std::array<double, 3> last_middle_{0.5, 0.5, 0.5};  // of the last cells of the rim, in cells
  double certain_ = 0;  // so far from a cell's middle, in cells, rounding changes nothing
  std::array<std::uint32_t, 3> width_{};  // with the rim
  unsigned level_ = 0;
  int inside_ = 1;
  // Side by side in the memory.
  Stretch* stretches_ = nullptr;
  MaskNode* records_ = nullptr;
};

}  // namespace planetree::octree
