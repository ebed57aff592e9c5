#include "octree/mask/side_grid.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstdlib>
#include <memory>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/mask/side_grid_builder.h"

namespace planetree::octree {
namespace {

// Rounds up to a multiple of a record's size.
constexpr std::size_t whole_records(std::size_t bytes) {
  return (bytes + sizeof(SideGridRecord) - 1) / sizeof(SideGridRecord) * sizeof(SideGridRecord);
}

}  // namespace

// Computes how many cells of a level the grid has, and where they are.
void SideGrid::measure(const Point& size, unsigned level, bool clipped, int scale) {
  constexpr std::uint32_t kRim = GridCoordinates::kRim;
  const double per_unit = 0.5 * static_cast<double>(std::uint64_t{1} << level);
  level_ = level;
  min_side_ = 0.25 / per_unit;
  coordinates_.model = FixedPoint(level, 0);
  // find_fast() is off for a region with walls and for extreme scales. It does not test walls,
  // beyond which the grid is not valid, and it does not read the bits of subnormal numbers.
  const bool certain = !clipped && std::abs(scale) <= FixedPoint::kMaxScale;
  coordinates_.input = FixedPoint(level, certain ? scale : FixedPoint::kNoScale);
  // The steps of the point and of the box err by one each, faces by 2^-53 of the greatest
  // coordinate.
  constexpr std::int64_t kGridUncertainty = 1 << 8;
  const double error = kGridFaceRounding * (lower_.cwiseAbs().maxCoeff() + kMaxDiagonal) *
                       per_unit * FixedPoint::kCell;
  bool near = 2 + error < kGridUncertainty;
  std::size_t stride = 1;
  for (unsigned axis = 0; axis < 3; ++axis) {
    width_[axis] = static_cast<std::uint32_t>(size[axis] * per_unit) + 1 + 2 * kRim;
    coordinates_.stride[axis] = stride;
    stride *= bricks_along(axis);
    coordinates_.last_middle[axis] =
        (width_[axis] - 1) * FixedPoint::kCell + GridCoordinates::kRimMiddle;
    const FixedPoint::Digits lower = coordinates_.model.digits_of(lower_[axis]);
    near = near && lower.shift > 1;
    coordinates_.first[axis] =
        near ? lower.steps() - kRim * FixedPoint::kCell - kGridUncertainty : 0;
  }
  coordinates_.uncertainty = 2 * (near ? kGridUncertainty : GridCoordinates::kMin);
}

// Fills in the cells of a level and what is known about the grey ones. Returns false if `memory` is
// too small for it.
bool SideGrid::fill_cells(const MaskInfo& mask, const CapGrid& caps, const PageReader& pages,
                          bool clipped, std::span<std::byte> memory) {
  const double brick_count = 1.0 * bricks_along(0) * bricks_along(1) * bricks_along(2);
  if (brick_count > static_cast<double>(memory.size())) return false;
  const auto bricks = static_cast<std::size_t>(brick_count);
  const std::size_t index_bytes = whole_records(bricks * sizeof(std::uint32_t));
  const std::size_t code_bytes = whole_records(bricks * sizeof(SideGridCells::Codes));
  if (index_bytes + code_bytes > memory.size()) return false;
  // The builder writes codes to the end of the memory. Records go there once these are laid out.
  const std::size_t filled_at =
      (memory.size() - code_bytes) / alignof(SideGridRecord) * alignof(SideGridRecord);
  const std::span<SideGridCells::Codes> filled(
      reinterpret_cast<SideGridCells::Codes*>(memory.data() + filled_at), bricks);
  std::uninitialized_fill(filled.begin(), filled.end(), SideGridCells::kUnfilled);
  SideGridBuilder builder(*this, filled, mask, caps, pages, clipped);
  builder.fill_cells();
  cells_.first_word = reinterpret_cast<std::uint32_t*>(memory.data());
  cells_.words = reinterpret_cast<std::uint64_t*>(memory.data() + index_bytes);
  const std::size_t capacity = (filled_at - index_bytes) / sizeof(std::uint64_t);
  const std::size_t words = cells_.lay_out(filled, capacity);
  if (words > capacity) return false;
  builder.fill_octants();
  const std::size_t records = cells_.count_records(bricks);
  const std::size_t cell_bytes = index_bytes + whole_records(words * sizeof(std::uint64_t));
  if (cell_bytes + records * sizeof(SideGridRecord) > memory.size()) return false;
  cells_.records = reinterpret_cast<SideGridRecord*>(memory.data() + cell_bytes);
  std::uninitialized_value_construct_n(cells_.records, records);
  builder.fill_records();
  return true;
}

void SideGrid::fill(const MaskInfo& mask, const TreeInfo& tree, const CapGrid& caps, bool clipped,
                    int scale, const PageReader& pages, std::span<std::byte> memory) noexcept {
  // A forged header may state a box that does not fit into the root.
  const Point size = tree.core_upper - mask.lower;
  const bool fits = (size.array() >= 0).all() && (size.array() <= 2).all();
  if (mask.page_count == 0 || !fits) return;
  assert(reinterpret_cast<std::uintptr_t>(memory.data()) % alignof(SideGridRecord) == 0);
  lower_ = mask.lower;
  // Takes the finest level that fits into the memory.
  for (unsigned level = kLevels - 2; level > 0; --level) {
    measure(size, level, clipped, scale);
    if (fill_cells(mask, caps, pages, clipped, memory)) return;
  }
  *this = {};
}

}  // namespace planetree::octree
