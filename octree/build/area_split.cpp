#include "octree/build/area_split.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "octree/build/float_rounding.h"
#include "octree/frame.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

using Order = std::array<std::uint16_t, kMaxAreaSplit>;

float centre2(const SplitItem& item, std::size_t axis) {
  return item.box.lower[axis] + item.box.upper[axis];
}

void sort_by_axis(std::span<const SplitItem> items, std::size_t axis, Order& order) {
  for (std::size_t i = 0; i < items.size(); ++i) order[i] = static_cast<std::uint16_t>(i);
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(items.size()),
            [&](std::uint16_t a, std::uint16_t b) {
              const float left = centre2(items[a], axis);
              const float right = centre2(items[b], axis);
              return left < right ||
                     (left == right && items[a].key.position < items[b].key.position);
            });
}

float blocks_for(std::size_t triangles) {
  const std::size_t blocks = (triangles + kMaxBlockTriangles - 1) / kMaxBlockTriangles;
  return static_cast<float>(blocks);
}

struct Split {
  float cost = std::numeric_limits<float>::infinity();
  std::uint32_t left_count = 0;

  // How far from halves.
  std::uint32_t skew(std::size_t count) const {
    const auto all = static_cast<std::uint32_t>(count);
    return std::max(2 * left_count, all) - std::min(2 * left_count, all);
  }
};

Split best_on_axis(std::span<const SplitItem> items, const Order& order) {
  std::array<float, kMaxAreaSplit> right_area{};
  FloatBox box = empty_box();
  for (std::size_t i = items.size(); i-- > 1;) {
    extend(box, items[order[i]].box);
    right_area[i] = half_area(box);
  }
  Split best;
  box = empty_box();
  for (std::size_t i = 1; i < items.size(); ++i) {
    extend(box, items[order[i - 1]].box);
    const float cost =
        half_area(box) * blocks_for(i) + right_area[i] * blocks_for(items.size() - i);
    const Split split{cost, static_cast<std::uint32_t>(i)};
    // Coincident triangles all cost the same: peeled off block by block they would make a
    // chain.
    if (cost < best.cost || (cost == best.cost && best.left_count != 0 &&
                             split.skew(items.size()) < best.skew(items.size())))
      best = split;
  }
  return best;
}

}  // namespace

std::uint32_t split_by_area(std::span<SplitItem> items) {
  assert(items.size() > kMaxBlockTriangles && items.size() <= kMaxAreaSplit);
  Split best;
  Order best_order{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Order order;
    sort_by_axis(items, axis, order);
    const Split split = best_on_axis(items, order);
    if (split.cost < best.cost || axis == 0) {
      best = split;
      best_order = order;
    }
  }
  // Flat or overflowing boxes have no best cost: halve, in whole blocks.
  if (best.left_count == 0)
    best.left_count = static_cast<std::uint32_t>((items.size() / 2 + 15) / 16 * 16);
  std::array<SplitItem, kMaxAreaSplit> sorted;
  for (std::size_t i = 0; i < items.size(); ++i) sorted[i] = items[best_order[i]];
  std::copy_n(sorted.begin(), items.size(), items.begin());
  return best.left_count;
}

}  // namespace planetree::octree
