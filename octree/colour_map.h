#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/cell_grid.h"
#include "octree/cell_steps.h"
#include "octree/map_record.h"
#include "octree/mask_frame.h"
#include "octree/mask_lookup.h"
#include "octree/tree_view.h"

namespace planetree::octree {

/// A mask's cells of one level side by side, with a rim of white ones about the model's box, and
/// in the grey ones those of two levels more: one look tells the side of most points, and needs
/// no page. For the rest there are records of the mask, so that a lookup need not begin at the
/// root. Filled once; then any thread may look.
class ColourMap {
 public:
  /// Memory of the map of a model of so many triangles.
  static constexpr std::size_t bytes(std::uint64_t triangles) {
    constexpr std::uint64_t kFewestBytes = 1024, kMostBytes = std::uint64_t{3} << 19;
    return std::clamp(triangles + triangles / 2, kFewestBytes, kMostBytes);
  }

  /// A map that knows nothing; as do those of models so far from the origin that steps have no
  /// room: some 2^25 times their size.
  ColourMap() = default;

  /// Of a mask's first pages, as far as they can be had.
  ///
  /// clipped  by the walls of a region, so that cells' octants may be others than halves.
  /// scale    model frame's units are 2^scale of the input's.
  /// memory   where the map is to be, on a boundary of 8 bytes; must outlive this.
  void fill(const MaskFacts& mask, const TreeFacts& tree, bool clipped, int scale, PageReader pages,
            std::span<std::byte> memory) noexcept;

  static constexpr int kUnknown = 2;

  /// What the map knows of the place where a point is.
  struct Spot {
    int winding = kUnknown;             ///< its sign, where that is known; else kUnknown
    GridCell cell;                      ///< grey: the one that
    const MapRecord* record = nullptr;  ///< this is of; null where the map has none
  };
  Spot look(const Point& point) const noexcept {
    Place place;
    const bool told = find(point.data(), steps_, place) || find_among_sides(point, place);
    return told ? look_at(place) : Spot{};
  }
  /// The same, of a point in the input's units, where whole numbers tell it: nothing is computed
  /// with doubles. What is no number is not known.
  Spot glance(const double* point) const noexcept {
    Place place;
    return find(point, input_steps_, place) ? look_at(place) : Spot{};
  }

 private:
  class Painter;

  enum Code : unsigned {
    kWhite = 0,
    kInside = 1,  ///< of the sign `inside_`
    kListed,      ///< grey, with a record
    kOther,       ///< nothing is known here
  };
  static constexpr std::uint32_t kRim = 1;  ///< cells before, and behind, those of the box

  /// The codes of some cells, a bit of each in either word.
  struct Stretch {
    static constexpr unsigned kCells = 64;
    std::uint64_t low, high;
  };
  static constexpr Stretch kUnpainted{~std::uint64_t{0}, ~std::uint64_t{0}};

  /// The colours of the cells two levels below a listed one, x first: `inside` of its sign.
  struct Quarters {
    std::uint64_t unknown, inside;
  };
  static constexpr Quarters kNoQuarters{~std::uint64_t{0}, 0};
  /// Of the cells one level below.
  using Octants = std::array<MapRecord, 8>;
  static constexpr std::size_t kListedBytes =
      sizeof(Quarters) + sizeof(Octants) + sizeof(MapRecord);

  static constexpr std::size_t stretches_for(std::uint64_t cells) {
    return static_cast<std::size_t>((cells + Stretch::kCells - 1) / Stretch::kCells);
  }

  /// Where a point is in the map, with the rim; right but for the bits below a quarter.
  struct Place {
    std::array<std::int64_t, 3> step;

    std::array<std::uint32_t, 3> cell() const {
      return {part(0, CellSteps::kBits), part(1, CellSteps::kBits), part(2, CellSteps::kBits)};
    }
    unsigned octant() const {
      constexpr unsigned kHalf = CellSteps::kBits - 1;
      return (part(0, kHalf) & 1) | (part(1, kHalf) & 1) << 1 | (part(2, kHalf) & 1) << 2;
    }
    /// As in Quarters.
    unsigned quarter() const {
      return (part(0, kQuarterBits) & 3) | (part(1, kQuarterBits) & 3) << 2 |
             (part(2, kQuarterBits) & 3) << 4;
    }
    std::uint32_t part(std::size_t axis, unsigned shift) const {
      return static_cast<std::uint32_t>(step[axis] >> shift);
    }
  };

  // False where the point is so near to a side that rounding may tell another quarter, or so far
  // that it has no place.
  bool find(const double* point, const CellSteps& steps, Place& place) const {
    std::int64_t doubtful = 0;  // below 0 if so
#pragma GCC unroll 3
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const CellSteps::Digits digits = steps.digits_of(point[axis]);
      const std::int64_t beyond = digits.steps() - first_step_[axis];
      const std::int64_t step = std::min(std::max(kRimMiddle, beyond), last_middle_[axis]);
      place.step[axis] = step;
      doubtful |= digits.shift;
      doubtful |= ((step + doubt_) & (kQuarter - 1)) - 2 * doubt_;
    }
    return doubtful >= 0;
  }
  // As rounded, sides may be elsewhere than steps say.
  bool find_among_sides(const Point& point, Place& place) const {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const std::int64_t at = place.step[axis] >> CellSteps::kBits;
      if (at < kRim || at + kRim >= width_[axis]) return false;
      const std::int64_t first = 4 * (at - kRim);
      if (!(side(axis, first) <= point[axis] && point[axis] < side(axis, first + 4))) return false;
      std::int64_t quarters = side(axis, first + 2) <= point[axis] ? 2 : 0;
      if (side(axis, first + quarters + 1) <= point[axis]) ++quarters;
      place.step[axis] = at * CellSteps::kCell + quarters * kQuarter;
    }
    return true;
  }
  Spot look_at(const Place& place) const {
    const std::size_t number = this->number(place.cell());
    const unsigned code = code_of(number);
    // By no branch: points come from either side.
    if (code <= kInside) return {static_cast<int>(code) * inside_, {}, nullptr};
    if (code == kOther) return {};
    return look_below(place, record_number(number));
  }
  std::size_t number(const std::array<std::uint32_t, 3>& at) const {
    return (std::size_t{at[2]} * width_[1] + at[1]) * width_[0] + at[0];
  }
  unsigned code_of(std::size_t cell) const {
    const Stretch& stretch = stretches_[cell / Stretch::kCells];
    const std::size_t at = cell % Stretch::kCells;
    return static_cast<unsigned>((stretch.low >> at & 1) | (stretch.high >> at & 1) << 1);
  }
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
  // In the listed cell that has this record.
  Spot look_below(const Place& place, std::size_t number) const {
    const MapRecord& record = records_[number];
    const unsigned octant = place.octant();
    // Most often there is no need of a quarter, whose line is another.
    if (record.is_node() && (record.grey >> octant & 1) == 0)
      return {(record.black >> octant & 1) - (record.inverted >> octant & 1), {}, nullptr};
    // What may be needed next, that it comes at the same time.
    __builtin_prefetch(&octants_[number]);
    const Quarters& quarters = quarters_[number];
    const unsigned quarter = place.quarter();
    if ((quarters.unknown >> quarter & 1) == 0)
      return {static_cast<int>(quarters.inside >> quarter & 1) * inside_, {}, nullptr};
    const MapRecord& below = octants_[number][octant];
    if (below.is_nothing()) return {};
    const auto at = place.cell();
    const GridCell cell{level_, {at[0] - kRim, at[1] - kRim, at[2] - kRim}};
    return {kUnknown, cell.child(octant).ancestor(level_ + 1 - below.levels_above()), &below};
  }
  // As CellGrid's; in quarters of cells.
  double side(unsigned axis, std::int64_t at) const {
    return lower_[axis] + quarter_side_ * static_cast<double>(at);
  }
  void measure(const Point& size, unsigned level, int scale);

  static constexpr unsigned kQuarterBits = CellSteps::kBits - 2;
  static constexpr std::int64_t kQuarter = std::int64_t{1} << kQuarterBits;
  // In the rim, and off the sides of quarters.
  static constexpr std::int64_t kRimMiddle = CellSteps::kCell / 2 + kQuarter / 2;

  // What most looks need, side by side.
  CellSteps input_steps_;
  std::array<std::int64_t, 3> first_step_{};  ///< of the rim
  std::array<std::int64_t, 3> last_middle_{kRimMiddle, kRimMiddle, kRimMiddle};
  // Steps from a side within which it is left to rounding; so many that none is without doubt.
  std::int64_t doubt_ = kQuarter;
  std::array<std::uint32_t, 3> width_{};  // with the rim
  int inside_ = 1;
  // Side by side in the memory; of listed cells, in their order, but for the first.
  Stretch* stretches_ = nullptr;
  Quarters* quarters_ = nullptr;
  Octants* octants_ = nullptr;
  MapRecord* records_ = nullptr;            ///< their own
  std::uint32_t* first_records_ = nullptr;  ///< of each stretch
  unsigned level_ = 0;
  CellSteps steps_;
  Point lower_ = Point::Zero();
  double quarter_side_ = 0;
};

/// Finds the cell of the mask that a point is in, from where a map of the mask's colours has found
/// `spot` for it.
MaskFinding look_up(const MaskFacts& mask, const ColourMap::Spot& spot, const Point& point,
                    std::uint64_t max_nodes, PageReader pages, TreeWork& work) noexcept;

}  // namespace planetree::octree
