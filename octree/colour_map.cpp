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
void ColourMap::measure(const Point& size, unsigned level, int scale) {
  const double per_unit = 0.5 * static_cast<double>(std::uint64_t{1} << level);
  level_ = level;
  quarter_side_ = 0.25 / per_unit;
  steps_ = CellSteps(level, 0);
  // With a scale that is told of no more, every place is too far for a glance.
  const bool told = std::abs(scale) <= CellSteps::kMostScale;
  input_steps_ = CellSteps(level, told ? scale : CellSteps::kNoScale);
  bool near = true;
  for (unsigned axis = 0; axis < 3; ++axis) {
    width_[axis] = static_cast<std::uint32_t>(size[axis] * per_unit) + 1 + 2 * kRim;
    last_middle_[axis] = (width_[axis] - 1) * CellSteps::kCell + kRimMiddle;
    const CellSteps::Digits lower = steps_.digits_of(lower_[axis]);
    near = near && lower.shift > 1;
    first_step_[axis] = near ? lower.steps() - kRim * CellSteps::kCell : 0;
  }
  // Steps err by one each of the point and of the box, sides by 2^-53 of the largest.
  constexpr std::int64_t kDoubt = 1 << 8;
  const double error = 0x1p-53 * (lower_.cwiseAbs().maxCoeff() + 4) * per_unit * CellSteps::kCell;
  doubt_ = near && 2 + error < kDoubt ? kDoubt : kQuarter;
}

void ColourMap::fill(const MaskFacts& mask, const TreeFacts& tree, bool clipped, int scale,
                     PageReader pages, std::span<std::byte> memory) noexcept {
  // A forged header may tell of a box that does not fit the root.
  const Point size = tree.box_upper - mask.lower;
  const bool fits = (size.array() >= 0).all() && (size.array() <= 2).all();
  if (mask.page_count == 0 || !fits) return;
  assert(reinterpret_cast<std::uintptr_t>(memory.data()) % alignof(Stretch) == 0);
  lower_ = mask.lower;
  // The finest cells that there is room for, and for what is known of those that are grey.
  for (unsigned level = kLevels - 2; level > 0; --level) {
    measure(size, level, scale);
    const double cells = 1.0 * width_[0] * width_[1] * width_[2];
    if (cells > 3.0 * static_cast<double>(memory.size())) continue;
    const std::size_t stretches = stretches_for(static_cast<std::uint64_t>(cells));
    // Of which whole words.
    const std::size_t firsts = stretches + stretches % 2;
    const std::size_t stretch_bytes = stretches * sizeof(Stretch) + firsts * sizeof(std::uint32_t);
    if (stretch_bytes > memory.size()) continue;
    stretches_ = reinterpret_cast<Stretch*>(memory.data());
    std::uninitialized_fill_n(stretches_, stretches, kUnpainted);
    first_records_ = reinterpret_cast<std::uint32_t*>(stretches_ + stretches);
    std::uninitialized_value_construct_n(first_records_, stretches);
    Painter painter(*this, mask, pages, clipped);
    const std::size_t listed = painter.paint();
    if (stretch_bytes + listed * kListedBytes > memory.size()) continue;
    quarters_ = reinterpret_cast<Quarters*>(memory.data() + stretch_bytes);
    std::uninitialized_fill_n(quarters_, listed, kNoQuarters);
    octants_ = reinterpret_cast<Octants*>(quarters_ + listed);
    std::uninitialized_value_construct_n(octants_, listed);
    records_ = reinterpret_cast<MapRecord*>(octants_ + listed);
    std::uninitialized_value_construct_n(records_, listed);
    return painter.fill_records();
  }
  *this = {};
}

}  // namespace planetree::octree
