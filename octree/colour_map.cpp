#include "octree/colour_map.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <memory>

#include "octree/mask_records.h"
#include "octree/strict_math.h"

namespace planetree::octree {

// Goes through the nodes of a mask's first pages, twice: to paint cells, and to fill in the
// records of those that are grey.
class ColourMap::Painter {
 public:
  Painter(ColourMap& map, const MaskFacts& mask, PageReader pages)
      : map_(map), mask_(mask), pages_(pages) {}

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
  // To a page and back: what opening a model may take.
  static constexpr std::uint64_t kMostTurns = 1 << 12;
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
    work_ = {};
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
    if (listed && !filling_) return each_cell(child, [&](std::size_t at) { set(at, kListed); });
    if (!records_->has_family_at_hand(node) && work_.page_turns >= kMostTurns) return;
    const std::uint32_t link = records_->child_link(node, octant);
    const std::byte* record = records_->record(link, leaf, work_);
    if (!record) return;
    if (!listed) return go_below(record, child);
    const MaskNode noted = leaf ? leaf_at(link, map_.level_ - child.level)
                                : *reinterpret_cast<const MaskNode*>(record);
    each_cell(child, [&](std::size_t at) {
      // A page may be had the second time alone; then its cells are not listed.
      if (map_.code_of(at) == kListed) map_.records_[map_.record_number(at)] = noted;
    });
  }

  static constexpr MaskNode leaf_at(std::uint32_t link, unsigned levels_above) {
    return {.family = link,
            .grey = 0,
            .leaf = kLeafTag,
            .black = static_cast<std::uint8_t>(levels_above),
            .inverted = 0};
  }

  void paint_colour(const GridCell& cell, int winding) {
    if (winding != 0 && !has_inside_) {
      has_inside_ = true;
      map_.inside_ = winding;
    }
    if (winding == 0 || winding == map_.inside_)
      each_cell(cell, [&](std::size_t at) { set(at, winding == 0 ? kWhite : kInside); });
  }

  // Calls with the number of each of the map's cells that are in a cell.
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
        for (std::uint32_t x = first[0]; x < end[0]; ++x) call(map_.number({x, y, z}));
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
  MaskRecords* records_ = nullptr;
  TreeWork work_;
  bool filling_ = false;
  bool has_inside_ = false;
};

void ColourMap::fill(const MaskFacts& mask, const TreeFacts& tree, PageReader pages,
                     std::span<std::byte> memory) noexcept {
  // A forged header may tell of a box that does not fit the root.
  const Point size = tree.box_upper - mask.lower;
  const bool fits = (size.array() >= 0).all() && (size.array() <= 2).all();
  if (mask.page_count == 0 || !fits) return;
  assert(reinterpret_cast<std::uintptr_t>(memory.data()) % alignof(Stretch) == 0);
  lower_ = mask.lower;
  // The finest cells that there is room for, and for the records of those that are grey.
  for (unsigned level = kLevels - 1; level > 0; --level) {
    const double per_unit = 0.5 * static_cast<double>(std::uint64_t{1} << level);
    double cells = 1;
    for (unsigned axis = 0; axis < 3; ++axis) {
      width_[axis] = static_cast<std::uint32_t>(size[axis] * per_unit) + 1 + 2 * kRim;
      last_middle_[axis] = (width_[axis] - 0.5) * kSteps;
      cells *= width_[axis];
    }
    if (cells > 3.0 * static_cast<double>(memory.size())) continue;
    const std::size_t stretches = stretches_for(static_cast<std::uint64_t>(cells));
    const std::size_t stretch_bytes = stretches * (sizeof(Stretch) + sizeof(std::uint32_t));
    if (stretch_bytes > memory.size()) continue;
    level_ = level;
    steps_per_unit_ = per_unit * kSteps;
    cell_side_ = 1 / per_unit;
    stretches_ = reinterpret_cast<Stretch*>(memory.data());
    std::uninitialized_fill_n(stretches_, stretches, kUnpainted);
    first_records_ = reinterpret_cast<std::uint32_t*>(stretches_ + stretches);
    std::uninitialized_value_construct_n(first_records_, stretches);
    Painter painter(*this, mask, pages);
    const std::size_t listed = painter.paint();
    if (stretch_bytes + listed * sizeof(MaskNode) > memory.size()) continue;
    records_ = reinterpret_cast<MaskNode*>(memory.data() + stretch_bytes);
    std::uninitialized_value_construct_n(records_, listed);
    painter.fill_records();
    // A difference, of at most 2, errs by 2^-53 of it, a side by 2^-53 of the largest, and what
    // is computed in cells by 2^-53 of their number, four times; twice that is allowed for.
    const double error = (lower_.cwiseAbs().maxCoeff() + 4) * per_unit +
                         4.0 * *std::max_element(width_.begin(), width_.end());
    const bool within_a_step = 0x1p-52 * error * kSteps < 1;
    within_cell_ = within_a_step ? (std::int64_t{1} << kStepBits) - 2 : 0;
    return;
  }
  *this = {};
}

}  // namespace planetree::octree
