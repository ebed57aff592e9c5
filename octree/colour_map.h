#pragma once

#include <algorithm>
#include <array>
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
  /// memory  where the map is to be, on a boundary of 8 bytes; must outlive this.
  void fill(const MaskFacts& mask, const TreeFacts& tree, PageReader pages,
            std::span<std::byte> memory) noexcept;

  static constexpr int kUnknown = 2;

  /// What the map knows of the place where a point is.
  struct Spot {
    int winding = kUnknown;            ///< its sign, where a cell is white or black; else kUnknown
    GridCell cell;                     ///< grey: the one that
    const MaskNode* record = nullptr;  ///< this is the record of; null where the map has none
  };
  Spot look(const Point& point) const noexcept {
    std::array<std::uint32_t, 3> at;
    if (!find(point, at)) return {};
    const std::size_t number = this->number(at);
    const unsigned code = code_of(number);
    // By no branch: points come from either side.
    if (code <= kInside) return {static_cast<int>(code) * inside_, {}, nullptr};
    if (code == kOther) return {};
    const MaskNode& record = record_of(number);
    const GridCell cell{level_, {at[0] - kRim, at[1] - kRim, at[2] - kRim}};
    if (is_leaf(record)) return {kUnknown, cell.ancestor(level_ - record.black), &record};
    if (record.grey == 0) return {};
    return {winding_below(record, point, at), cell, &record};
  }

  /// No node is stored so: a leaf, whose link is `family`; it may be of a level above, `black`
  /// ones.
  static constexpr bool is_leaf(const MaskNode& record) {
    return record.grey == 0 && record.leaf == kLeafTag;
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

  /// The codes of some cells, a bit of each in either word.
  struct Stretch {
    static constexpr unsigned kCells = 64;
    std::uint64_t low, high;
  };
  static_assert(sizeof(Stretch) % alignof(MaskNode) == 0);
  static constexpr Stretch kUnpainted{~std::uint64_t{0}, ~std::uint64_t{0}};

  static constexpr std::size_t stretches_for(std::uint64_t cells) {
    return static_cast<std::size_t>((cells + Stretch::kCells - 1) / Stretch::kCells);
  }

  // Which of the map's cells the point is in. False where rounding does not tell that cell for
  // certain, and where the map knows nothing.
  bool find(const Point& point, std::array<std::uint32_t, 3>& at) const {
    bool certain = true;
#pragma GCC unroll 3
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double place = (point[axis] - lower_[axis]) * steps_per_unit_ + kRim * kSteps;
      // What is no number is in the rim.
      const auto step =
          static_cast<std::int64_t>(std::min(std::max(kSteps / 2, place), last_middle_[axis]));
      at[axis] = static_cast<std::uint32_t>(step >> kStepBits);
      certain = certain && ((step + 1) & within_cell_) != 0;
    }
    return certain || find_among_sides(point, at);
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
    const Stretch& stretch = stretches_[cell / Stretch::kCells];
    const std::size_t at = cell % Stretch::kCells;
    return static_cast<unsigned>((stretch.low >> at & 1) | (stretch.high >> at & 1) << 1);
  }
  const MaskNode& record_of(std::size_t cell) const { return records_[record_number(cell)]; }
  // Of a listed cell: as many are listed before it.
  std::uint32_t record_number(std::size_t cell) const {
    const Stretch& stretch = stretches_[cell / Stretch::kCells];
    const std::uint64_t before = (std::uint64_t{1} << cell % Stretch::kCells) - 1;
    return first_records_[cell / Stretch::kCells] + count(listed_in(stretch) & before);
  }
  static constexpr std::uint64_t listed_in(const Stretch& stretch) {
    return stretch.high & ~stretch.low;
  }
  // The processors we build for may lack an instruction for it.
  static constexpr std::uint32_t count(std::uint64_t set) {
    set -= set >> 1 & 0x5555555555555555;
    set = (set & 0x3333333333333333) + (set >> 2 & 0x3333333333333333);
    set = (set + (set >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return static_cast<std::uint32_t>(set * 0x0101010101010101 >> 56);
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

  // Points are told apart in steps, so many to a cell.
  static constexpr unsigned kStepBits = 20;
  static constexpr double kSteps = std::int64_t{1} << kStepBits;

  Point lower_ = Point::Zero();
  double cell_side_ = 0;
  double steps_per_unit_ = 0;
  // Of the last cells of the rim, in steps.
  std::array<double, 3> last_middle_{kSteps / 2, kSteps / 2, kSteps / 2};
  // Where a cell's first and last step are no others than its middle ones, rounding changes
  // nothing: of a step and 1 more, the bits that are not all 0 then.
  std::int64_t within_cell_ = 0;
  std::array<std::uint32_t, 3> width_{};  // with the rim
  unsigned level_ = 0;
  int inside_ = 1;
  // Side by side in the memory.
  Stretch* stretches_ = nullptr;
  MaskNode* records_ = nullptr;
  std::uint32_t* first_records_ = nullptr;  ///< of each stretch
};

/// Finds the cell of the mask that a point is in, from where a map of the mask's colours has found
/// `spot` for it.
MaskFinding look_up(const MaskFacts& mask, const ColourMap::Spot& spot, const Point& point,
                    std::uint64_t max_nodes, PageReader pages, TreeWork& work) noexcept;

}  // namespace planetree::octree
