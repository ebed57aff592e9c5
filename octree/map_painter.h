#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "octree/colour_map.h"
#include "octree/mask_records.h"

namespace planetree::octree {

/// Goes through the nodes of a mask's first pages, twice: to paint cells, and to fill in what is
/// known of those that are grey.
class ColourMap::Painter {
 public:
  Painter(ColourMap& map, const MaskFacts& mask, PageReader pages, bool clipped)
      : map_(map), mask_(mask), pages_(pages), clipped_(clipped) {}

  /// Returns how many cells are listed.
  std::uint32_t paint() {
    paint_rim();
    run(false);
    std::uint32_t listed_before = 0;
    for (std::size_t i = 0; i < stretches_for(cells()); ++i) {
      map_.first_records_[i] = listed_before;
      listed_before += count(listed_in(map_.stretches_[i]));
    }
    return listed_before;
  }
  void fill_records() { run(true); }

 private:
  using Place = std::array<std::uint32_t, 3>;

  // Pages that are not in memory: what opening a model may take.
  static constexpr std::uint64_t kMostBrought = 1 << 12;
  // Larger leaves would fill the map with their records.
  static constexpr unsigned kMostAbove = 2;

  std::uint64_t cells() const {
    return std::uint64_t{map_.width_[0]} * map_.width_[1] * map_.width_[2];
  }
  // Without the rim.
  std::uint32_t width(unsigned axis) const { return map_.width_[axis] - 2 * kRim; }

  void paint_rim() {
    const auto& end = map_.width_;
    for (std::uint32_t z = 0; z < end[2]; ++z)
      for (std::uint32_t y = 0; y < end[1]; ++y) {
        const bool all = z == 0 || z + 1 == end[2] || y == 0 || y + 1 == end[1];
        for (std::uint32_t x = 0; x < end[0]; x += all ? 1 : end[0] - 1)
          set(map_.number({x, y, z}), kWhite);
      }
  }

  void run(bool filling) {
    filling_ = filling;
    MaskRecords records(mask_, pages_);
    records_ = &records;
    brought_ = 0;
    const std::byte* root = records.root(work_);
    if (root && records.root_is_node() && map_.level_ > 0) go_below(root, {});
  }

  void go_below(const std::byte* record, const GridCell& cell) {
    const MaskNode node = *reinterpret_cast<const MaskNode*>(record);  // may go with its page
    for (unsigned octant = 0; octant < 8; ++octant) {
      const GridCell child = cell.child(octant);
      if ((node.grey >> octant & 1) != 0)
        go_to_grey(node, octant, child);
      else if (!filling_)
        paint_colour(child, (node.black >> octant & 1) - (node.inverted >> octant & 1));
    }
  }

  void go_to_grey(const MaskNode& node, unsigned octant, const GridCell& child) {
    for (unsigned axis = 0; axis < 3; ++axis)
      if (child.at[axis] << (map_.level_ - child.level) >= width(axis)) return;
    const bool leaf = (node.leaf >> octant & 1) != 0;
    const bool listed = child.level == map_.level_ || leaf;
    if (leaf && map_.level_ - child.level > kMostAbove) return;
    if (listed && !filling_)
      return each_cell(child, [&](const Place& at) { set(map_.number(at), kListed); });
    const std::byte* record = below(node, octant);
    if (!record) return;
    if (!listed) return go_below(record, child);
    if (leaf) return fill_leaf(record, records_->child_link(node, octant), child);
    const MaskNode divided = *reinterpret_cast<const MaskNode*>(record);
    each_cell(child, [&](const Place& at) {
      // A page may be had the second time alone; then its cells are not listed.
      if (map_.code_of(map_.number(at)) == kListed)
        fill_node(divided, child, map_.record_number(map_.number(at)));
    });
  }

  // The record of a grey octant; null where its page cannot be had, or is one too many.
  const std::byte* below(const MaskNode& node, unsigned octant) {
    if (!records_->has_family_at_hand(node) && ++brought_ > kMostBrought) return nullptr;
    const bool leaf = (node.leaf >> octant & 1) != 0;
    return records_->record(records_->child_link(node, octant), leaf, work_);
  }

  // A cell of the map's level, which is divided.
  void fill_node(const MaskNode node, const GridCell& cell, std::size_t number) {
    if (node.grey == 0) return;  // forged
    map_.records_[number] = MapRecord::of_node(node);
    for (unsigned octant = 0; octant < 8; ++octant) {
      if ((node.grey >> octant & 1) == 0) continue;
      const std::byte* record = below(node, octant);
      if (!record) continue;
      const GridCell child = cell.child(octant);
      if ((node.leaf >> octant & 1) != 0)
        fill_octant(read_leaf(record, records_->child_link(node, octant), child.level), child,
                    octant, number);
      else
        fill_divided(*reinterpret_cast<const MaskNode*>(record), octant, number);
    }
  }

  void fill_divided(const MaskNode& node, unsigned octant, std::size_t number) {
    if (node.grey == 0) return;  // forged
    map_.octants_[number][octant] = MapRecord::of_node(node);
    for (unsigned below = 0; below < 8; ++below)
      if ((node.grey >> below & 1) == 0)
        paint_quarter(octant, below, (node.black >> below & 1) - (node.inverted >> below & 1),
                      number);
  }

  // A leaf of the map's level or above.
  void fill_leaf(const std::byte* record, std::uint32_t link, const GridCell& leaf) {
    const Leaf found = read_leaf(record, link, leaf.level);
    each_cell(leaf, [&](const Place& at) {
      const std::size_t number = map_.number(at);
      if (map_.code_of(number) != kListed) return;
      const GridCell cell{map_.level_, {at[0] - kRim, at[1] - kRim, at[2] - kRim}};
      for (unsigned octant = 0; octant < 8; ++octant)
        fill_octant(found, cell.child(octant), octant, map_.record_number(number));
    });
  }

  // What is known of a leaf.
  struct Leaf {
    unsigned level = 0;
    std::uint32_t link = 0;
    bool listed = false;
    MaskListed head{};
    unsigned touched = 0xff;  // octants of it
  };

  Leaf read_leaf(const std::byte* record, std::uint32_t link, unsigned level) const {
    Leaf leaf{level, link};
    const auto& corners = *reinterpret_cast<const MaskCorners*>(record);
    if (!is_listed(corners)) return leaf;
    const auto& listed = *reinterpret_cast<const MaskListed*>(record);
    if (!MapRecord::has(listed)) return leaf;
    MaskBlocks blocks;
    copy_list(records_->slot(0), listed, blocks);
    leaf.link = records_->link_to(listed.list_slot);
    leaf.listed = true;
    leaf.head = listed;
    if (clipped_) return leaf;
    leaf.touched = 0;
    for (unsigned i = 0; i < blocks.count; ++i) leaf.touched |= blocks.octants[i];
    return leaf;
  }

  // An octant of a listed cell, which is that leaf or in it.
  void fill_octant(const Leaf& leaf, const GridCell& cell, unsigned octant, std::size_t number) {
    const unsigned above = cell.level - leaf.level;
    map_.octants_[number][octant] = leaf.listed ? MapRecord::of_list(leaf.head, leaf.link, above)
                                                : MapRecord::of_leaf(leaf.link, above);
    for (unsigned below = 0; below < 8; ++below) {
      const GridCell quarter = cell.child(below);
      unsigned of_leaf = 0;
      for (unsigned axis = 0; axis < 3; ++axis) of_leaf |= (quarter.at[axis] >> above & 1) << axis;
      if ((leaf.touched >> of_leaf & 1) == 0)
        paint_quarter(octant, below, corner_of(leaf.head, of_leaf), number);
    }
  }

  void paint_quarter(unsigned octant, unsigned below, int winding, std::size_t number) {
    if (!is_told(winding)) return;
    unsigned place = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      place |= (2 * (octant >> axis & 1) + (below >> axis & 1)) << 2 * axis;
    const std::uint64_t bit = std::uint64_t{1} << place;
    Quarters& quarters = map_.quarters_[number];
    quarters.unknown &= ~bit;
    if (winding != 0) quarters.inside |= bit;
  }

  // Insides of one sign alone: the first one's.
  bool is_told(int winding) {
    if (winding != 0 && !has_inside_) {
      has_inside_ = true;
      map_.inside_ = winding;
    }
    return winding == 0 || winding == map_.inside_;
  }

  void paint_colour(const GridCell& cell, int winding) {
    if (is_told(winding))
      each_cell(cell,
                [&](const Place& at) { set(map_.number(at), winding == 0 ? kWhite : kInside); });
  }
  // Calls with the place of each of the map's cells that are in a cell.
  template <class Call>
  void each_cell(const GridCell& cell, const Call& call) {
    const unsigned shift = map_.level_ - cell.level;
    std::array<std::uint32_t, 3> first{}, end{};
    for (unsigned axis = 0; axis < 3; ++axis) {
      first[axis] = (cell.at[axis] << shift) + kRim;
      end[axis] = std::min((cell.at[axis] + 1) << shift, width(axis)) + kRim;
    }
    for (std::uint32_t z = first[2]; z < end[2]; ++z)
      for (std::uint32_t y = first[1]; y < end[1]; ++y)
        for (std::uint32_t x = first[0]; x < end[0]; ++x) call(Place{x, y, z});
  }
  void set(std::size_t cell, Code code) {
    Stretch& stretch = map_.stretches_[cell / Stretch::kCells];
    const std::uint64_t bit = std::uint64_t{1} << cell % Stretch::kCells;
    stretch.low = (code & 1) != 0 ? stretch.low | bit : stretch.low & ~bit;
    stretch.high = (code & 2) != 0 ? stretch.high | bit : stretch.high & ~bit;
  }

  ColourMap& map_;
  const MaskFacts& mask_;
  const PageReader pages_;
  const bool clipped_;
  MaskRecords* records_ = nullptr;
  TreeWork work_;
  std::uint64_t brought_ = 0;
  bool filling_ = false;
  bool has_inside_ = false;
};

}  // namespace planetree::octree
