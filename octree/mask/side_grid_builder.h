#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid.h"

namespace planetree::octree {

/// Walks the nodes of a mask's first pages three times: to fill in the colours of cells, the
/// colours of the octants of grey cells, and the records of grey octants.
class SideGrid::SideGridBuilder {
 public:
  /// cells  receives the codes of bricks; not used once these are laid out.
  SideGridBuilder(SideGrid& grid, std::span<SideGridCells::Codes> cells, const MaskInfo& mask,
                  const CapGrid& caps, const PageReader& pages, bool clipped)
      : grid_(grid), cells_(cells), mask_(mask), caps_(caps), pages_(pages), clipped_(clipped) {}

  void fill_cells() {
    fill_rim();
    run(Pass::kCells);
  }
  void fill_octants() { run(Pass::kOctants); }
  void fill_records() { run(Pass::kRecords); }

 private:
  using Position = std::array<std::uint32_t, 3>;
  enum class Pass { kCells, kOctants, kRecords };
  static constexpr std::uint32_t kRim = GridCoordinates::kRim;

  // Maximum number of lookups of pages that are not resident, for one level of cells. It bounds
  // the time to open a model.
  static constexpr std::uint64_t kMaxBrought = 1 << 12;
  // Maximum number of levels from the grid's cells up to a leaf. Larger leaves would fill the grid
  // with their records.
  static constexpr unsigned kMaxAbove = 2;

  // Number of cells along an axis, without the rim.
  std::uint32_t width(unsigned axis) const { return grid_.width_[axis] - 2 * kRim; }

  // Makes the rim white, up to the ends of the bricks. Beside strays nothing is known of it.
  void fill_rim() {
    if (mask_.beside_strays) return;
    const auto in_rim = [&](unsigned axis, std::uint32_t at) {
      return at < kRim || at >= width(axis) + kRim;
    };
    const auto end = [&](unsigned axis) {
      return grid_.bricks_along(axis) << SideGridCells::kBrickBits;
    };
    for (std::uint32_t z = 0; z < end(2); ++z)
      for (std::uint32_t y = 0; y < end(1); ++y) {
        const bool all = in_rim(2, z) || in_rim(1, y);
        for (std::uint32_t x = 0; x < end(0); ++x)
          if ((all || in_rim(0, x)) && is_clear({x, y, z})) set({x, y, z}, SideGridCells::kWhite);
      }
  }

  void run(Pass pass) {
    pass_ = pass;
    MaskRecords records(mask_, pages_);
    records_ = &records;
    const std::byte* root = records.root(work_);
    if (root && records.root_is_node() && grid_.level_ > 0) go_below(root, {});
  }

  void go_below(const std::byte* record, const GridCell& cell) {
    const MaskNode node = *reinterpret_cast<const MaskNode*>(record);  // its page may be evicted
    for (unsigned octant = 0; octant < 8; ++octant) {
      const GridCell child = cell.child(octant);
      if (node.is_grey(octant))
        go_to_grey(node, octant, child);
      else if (pass_ == Pass::kCells)
        fill_colour(child, node.winding(octant));
    }
  }

  void go_to_grey(const MaskNode& node, unsigned octant, const GridCell& child) {
    for (unsigned axis = 0; axis < 3; ++axis)
      if (child.at[axis] << (grid_.level_ - child.level) >= width(axis)) return;
    const bool leaf = node.is_leaf(octant);
    const bool listed = child.level == grid_.level_ || leaf;
    if (leaf && grid_.level_ - child.level > kMaxAbove) return;
    if (listed && pass_ == Pass::kCells)
      return each_cell(child, [&](const Position& at) { set(at, SideGridCells::kListed); });
    const std::byte* record = below(node, octant);
    if (!record) return;
    if (!listed) return go_below(record, child);
    if (leaf) return go_to_leaf(read_leaf(record, records_->child_link(node, octant), child));
    go_to_node(*reinterpret_cast<const MaskNode*>(record), child);
  }

  // Returns the record of a grey octant; null if its page is missing or kMaxBrought is reached.
  const std::byte* below(const MaskNode& node, unsigned octant) {
    if (!records_->peek(node.family()) && ++brought_ > kMaxBrought) return nullptr;
    const bool leaf = node.is_leaf(octant);
    return records_->record(records_->child_link(node, octant), leaf, work_);
  }

  // Fills in what is below a node of the grid's level.
  void go_to_node(const MaskNode node, const GridCell& cell) {
    const Position at{cell.at[0] + kRim, cell.at[1] + kRim, cell.at[2] + kRim};
    for (unsigned octant = 0; octant < 8; ++octant) {
      if (!node.is_grey(octant)) {
        fill(at, octant, node.winding(octant));
        continue;
      }
      const std::byte* record = pass_ == Pass::kRecords ? below(node, octant) : nullptr;
      if (!record) continue;
      if (node.is_leaf(octant))
        note(at, octant,
             read_leaf(record, records_->child_link(node, octant), cell.child(octant)).record(0));
      else
        note(at, octant, SideGridRecord::of_node(*reinterpret_cast<const MaskNode*>(record)));
    }
  }

  // What the grid needs to know of a leaf.
  struct Leaf {
    GridCell cell;
    MaskLink link = 0;
    bool listed = false;
    MaskListed head{};
    CellSlab slab{};
    unsigned touched = 0xff;  // octants of the leaf that listed blocks touch

    SideGridRecord record(unsigned above) const {
      return listed ? SideGridRecord::of_list(head, link, slab, touched, above)
                    : SideGridRecord::of_leaf(link, above);
    }
  };

  Leaf read_leaf(const std::byte* record, MaskLink link, const GridCell& cell) const {
    Leaf leaf{cell, link};
    const auto& corners = *reinterpret_cast<const MaskCorners*>(record);
    if (!is_listed(corners)) return leaf;
    const auto& listed = *reinterpret_cast<const MaskListed*>(record);
    if (!SideGridRecord::has(listed)) return leaf;
    MaskBlocks blocks;
    copy_list(records_->slot(0), listed, blocks);
    leaf.link = records_->link_to(listed.list_slot);
    leaf.listed = true;
    leaf.head = listed;
    if (clipped_) return leaf;
    leaf.slab = blocks.slab;
    leaf.touched = 0;
    for (unsigned i = 0; i < blocks.count; ++i) leaf.touched |= blocks.octants[i];
    return leaf;
  }

  // Fills in the grid's cells within a leaf of the grid's level or above.
  void go_to_leaf(const Leaf& leaf) {
    const unsigned above = grid_.level_ + 1 - leaf.cell.level;
    each_cell(leaf.cell, [&](const Position& at) {
      const GridCell cell{grid_.level_, {at[0] - kRim, at[1] - kRim, at[2] - kRim}};
      for (unsigned octant = 0; octant < 8; ++octant) {
        const unsigned of_leaf = cell.child(octant).octant_of(leaf.cell.level + 1);
        if ((leaf.touched >> of_leaf & 1) == 0)
          fill(at, octant, corner_number(leaf.head, of_leaf));
        else
          note(at, octant, leaf.record(above));
      }
    });
  }

  void fill(const Position& at, unsigned octant, int winding) {
    if (!is_certain(winding)) return note(at, octant, SideGridRecord::of_colour(winding));
    if (pass_ != Pass::kOctants || !is_listed_at(at) || !is_clear(at, octant)) return;
    const SideGridCells::Octant filled =
        grid_.cells_.octant_of(grid_.coordinates_.cell_at(at), octant);
    filled.group.unknown &= ~filled.bit;
    if (winding != 0) filled.group.inside |= filled.bit;
  }
  void note(const Position& at, unsigned octant, const SideGridRecord& record) {
    // A record tells sides too.
    if (pass_ != Pass::kRecords || !is_listed_at(at) || !is_clear(at, octant)) return;
    const SideGridCells::Octant noted =
        grid_.cells_.octant_of(grid_.coordinates_.cell_at(at), octant);
    if (noted.is_unknown()) grid_.cells_.records[noted.record()] = record;
  }
  // A page that was missing in the first pass may be available later; its cells are not listed.
  bool is_listed_at(const Position& at) const {
    return grid_.cells_.code_of(grid_.coordinates_.cell_at(at)) == SideGridCells::kListed;
  }
  // Whether the caps leave sides in a cell of the grid, or in an octant of it, to the mask.
  bool is_clear(const Position& at) const { return is_clear_box(at, {0, 0, 0}, 4); }
  bool is_clear(const Position& at, unsigned octant) const {
    return is_clear_box(at, {2 * (octant & 1), octant & 2, octant >> 1 & 2}, 2);
  }
  // offset, width  in octants of octants
  bool is_clear_box(const Position& at, const Position& offset, int width) const {
    Point lower;
    for (unsigned axis = 0; axis < 3; ++axis)
      lower[axis] = grid_.side(axis, 4 * (std::int64_t{at[axis]} - kRim) + offset[axis]);
    return caps_.is_clear_box(lower, lower + Point::Constant(width * grid_.min_side_));
  }
  void set(const Position& at, SideGridCells::Code code) {
    const SideGridCells::Cell cell = grid_.coordinates_.cell_at(at);
    cells_[cell.brick].set(cell.at, code);
  }

  // Codes have one sign for all inside cells: that of the first one found.
  bool is_certain(int winding) {
    if (winding != 0 && !has_inside_) {
      has_inside_ = true;
      grid_.cells_.inside = winding;
    }
    return winding == 0 || winding == grid_.cells_.inside;
  }

  void fill_colour(const GridCell& cell, int winding) {
    if (!is_certain(winding)) return;
    const CellGrid grid(mask_.lower);
    const bool all_clear = caps_.is_clear_box(grid.lower(cell), grid.upper(cell));
    each_cell(cell, [&](const Position& at) {
      if (all_clear || is_clear(at))
        set(at, winding == 0 ? SideGridCells::kWhite : SideGridCells::kInside);
    });
  }
  // Calls call(position) for each of the grid's cells within a cell.
  template <class Call>
  void each_cell(const GridCell& cell, const Call& call) {
    const unsigned shift = grid_.level_ - cell.level;
    std::array<std::uint32_t, 3> first{}, end{};
    for (unsigned axis = 0; axis < 3; ++axis) {
      first[axis] = (cell.at[axis] << shift) + kRim;
      end[axis] = std::min((cell.at[axis] + 1) << shift, width(axis)) + kRim;
    }
    for (std::uint32_t z = first[2]; z < end[2]; ++z)
      for (std::uint32_t y = first[1]; y < end[1]; ++y)
        for (std::uint32_t x = first[0]; x < end[0]; ++x) call(Position{x, y, z});
  }
  SideGrid& grid_;
  const std::span<SideGridCells::Codes> cells_;
  const MaskInfo& mask_;
  const CapGrid& caps_;
  const PageReader pages_;
  const bool clipped_;
  MaskRecords* records_ = nullptr;
  TraversalStats work_;
  std::uint64_t brought_ = 0;
  Pass pass_ = Pass::kCells;
  bool has_inside_ = false;
};

}  // namespace planetree::octree
