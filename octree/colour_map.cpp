#include "octree/colour_map.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "octree/map_painter.h"
#include "octree/strict_math.h"

namespace planetree::octree {

// How many cells there are of a level, and where.
void ColourMap::measure(const Point& size, unsigned level, bool clipped, int scale) {
  constexpr std::uint32_t kRim = MapSteps::kRim;
  const double per_unit = 0.5 * static_cast<double>(std::uint64_t{1} << level);
  level_ = level;
  least_side_ = 0.25 / per_unit;
  steps_.model = CellSteps(level, 0);
  // What is beyond a wall of a region is not the map's to know, and a glance does not see walls;
  // nor bits of subnormal numbers.
  const bool told = !clipped && std::abs(scale) <= CellSteps::kMostScale;
  steps_.input = CellSteps(level, told ? scale : CellSteps::kNoScale);
  // Steps err by one each of the point and of the box, sides by 2^-53 of the largest.
  constexpr std::int64_t kDoubt = 1 << 8;
  const double error = 0x1p-53 * (lower_.cwiseAbs().maxCoeff() + 4) * per_unit * CellSteps::kCell;
  bool near = 2 + error < kDoubt;
  std::size_t stride = 1;
  for (unsigned axis = 0; axis < 3; ++axis) {
    width_[axis] = static_cast<std::uint32_t>(size[axis] * per_unit) + 1 + 2 * kRim;
    steps_.stride[axis] = stride;
    stride *= width_[axis];
    steps_.last_middle[axis] = (width_[axis] - 1) * CellSteps::kCell + MapSteps::kRimMiddle;
    const CellSteps::Digits lower = steps_.model.digits_of(lower_[axis]);
    near = near && lower.shift > 1;
    steps_.first[axis] = near ? lower.steps() - kRim * CellSteps::kCell - kDoubt : 0;
  }
  steps_.doubtful = 2 * (near ? kDoubt : MapSteps::kLeast);
}

void ColourMap::fill(const MaskFacts& mask, const TreeFacts& tree, bool clipped, int scale,
                     const PageReader& pages, std::span<std::byte> memory) noexcept {
  // A forged header may tell of a box that does not fit the root.
  const Point size = tree.box_upper - mask.lower;
  const bool fits = (size.array() >= 0).all() && (size.array() <= 2).all();
  if (mask.page_count == 0 || !fits) return;
  assert(reinterpret_cast<std::uintptr_t>(memory.data()) % alignof(MapRecord) == 0);
  lower_ = mask.lower;
  // The finest cells that there is room for, and for what is known of those that are grey.
  for (unsigned level = kLevels - 2; level > 0; --level) {
    measure(size, level, clipped, scale);
    const double cells = 1.0 * width_[0] * width_[1] * width_[2];
    if (cells > 3.0 * static_cast<double>(memory.size())) continue;
    // Of which whole records.
    const std::size_t stretches =
        (MapCells::stretches_for(static_cast<std::uint64_t>(cells)) + 3) / 4 * 4;
    const std::size_t stretch_bytes = stretches * sizeof(MapCells::Stretch);
    if (stretch_bytes > memory.size()) continue;
    cells_.stretches = reinterpret_cast<MapCells::Stretch*>(memory.data());
    std::uninitialized_fill_n(cells_.stretches, stretches, MapCells::kUnpainted);
    Painter painter(*this, mask, pages, clipped);
    const std::size_t listed = painter.paint_cells();
    // Of which whole records, too.
    const std::size_t groups = (MapCells::groups_for(listed) + 1) / 2 * 2;
    const std::size_t group_bytes = stretch_bytes + groups * sizeof(MapCells::Group);
    if (group_bytes > memory.size()) continue;
    cells_.groups = reinterpret_cast<MapCells::Group*>(cells_.stretches + stretches);
    cells_.clear_groups(listed);
    painter.paint_octants();
    const std::size_t records = cells_.count_records(MapCells::groups_for(listed));
    if (group_bytes + records * sizeof(MapRecord) > memory.size()) continue;
    cells_.records = reinterpret_cast<MapRecord*>(cells_.groups + groups);
    std::uninitialized_value_construct_n(cells_.records, records);
    return painter.fill_records();
  }
  *this = {};
}

}  // namespace planetree::octree
