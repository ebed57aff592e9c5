#include "octree/builder/tree/area_split.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

#include "octree/geometry/strict_math.h"
#include "octree/page/frame.h"

namespace planetree::octree {
namespace {

using WideBox = AreaSplitter::WideBox;

class GrowingBox {
 public:
  void extend(const WideBox& box) {
    box_.lower = box_.lower.min(box.lower);
    box_.upper = box_.upper.max(box.upper);
  }
  float half_area() const {
    const Eigen::Array4f edge = box_.upper - box_.lower;
    return edge[0] * edge[1] + edge[1] * edge[2] + edge[2] * edge[0];
  }

 private:
  WideBox box_{Eigen::Array4f::Constant(std::numeric_limits<float>::infinity()),
               Eigen::Array4f::Constant(-std::numeric_limits<float>::infinity())};
};

float centre2(const SplitItem& item, std::size_t axis) {
  return item.box.lower[axis] + item.box.upper[axis];
}

// Bits that have the order of the floats; both zeros give the same bits.
std::uint32_t ordered_bits(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value + 0.0f);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000U;
}

float blocks_for(std::size_t triangles) {
  const std::size_t blocks = (triangles + kMaxBlockTriangles - 1) / kMaxBlockTriangles;
  return static_cast<float>(blocks);
}

// Difference in size between the two parts.
std::uint32_t skew(std::uint32_t left_count, std::uint32_t count) {
  return std::max(2 * left_count, count) - std::min(2 * left_count, count);
}

}  // namespace

AreaSplitter::AreaSplitter(std::span<const SplitItem> items) : items_(items) {
  assert(items.size() <= kMaxAreaSplit);
  for (std::size_t axis = 0; axis < 3; ++axis) sort(axis);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto& [lower, upper] = items[i].box;
    boxes_[i] = {{lower[0], lower[1], lower[2], 0}, {upper[0], upper[1], upper[2], 0}};
    last_[i] = static_cast<std::uint16_t>(i);
  }
}

void AreaSplitter::sort(std::size_t axis) {
  struct Key {
    std::uint64_t value;  // coordinate, then position
    std::uint16_t item;
  };
  std::array<Key, kMaxAreaSplit> keys;
  for (std::size_t i = 0; i < items_.size(); ++i)
    keys[i] = {std::uint64_t{ordered_bits(centre2(items_[i], axis))} << 32 | items_[i].key.position,
               static_cast<std::uint16_t>(i)};
  std::sort(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(items_.size()),
            [](const Key& a, const Key& b) { return a.value < b.value; });
  for (std::size_t i = 0; i < items_.size(); ++i) order_[axis][i] = keys[i].item;
}

AreaSplitter::Split AreaSplitter::best_on(const Order& order, std::uint32_t begin,
                                          std::uint32_t end) const {
  const std::uint32_t count = end - begin;
  std::array<float, kMaxAreaSplit> right_area;
  GrowingBox right;
  for (std::uint32_t i = count; i-- > 1;) {
    right.extend(boxes_[order[begin + i]]);
    right_area[i] = right.half_area();
  }
  Split best{std::numeric_limits<float>::infinity(), 0};
  GrowingBox left;
  for (std::uint32_t i = 1; i < count; ++i) {
    left.extend(boxes_[order[begin + i - 1]]);
    const float cost = left.half_area() * blocks_for(i) + right_area[i] * blocks_for(count - i);
    // All splits of coincident triangles cost the same. Splitting off one block at a time would
    // make a chain.
    if (cost < best.cost || (cost == best.cost && best.left_count != 0 &&
                             skew(i, count) < skew(best.left_count, count)))
      best = {cost, i};
  }
  return best;
}

std::uint32_t AreaSplitter::split(std::uint32_t begin, std::uint32_t end) {
  assert(end - begin > kMaxBlockTriangles);
  Split best{};
  std::size_t best_axis = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Split found = best_on(order_[axis], begin, end);
    if (axis > 0 && !(found.cost < best.cost)) continue;
    best = found;
    best_axis = axis;
  }
  // Flat or overflowing boxes have no least cost: they are halved, in whole blocks.
  if (best.left_count == 0)
    best.left_count =
        ((end - begin) / 2 + kMaxBlockTriangles - 1) / kMaxBlockTriangles * kMaxBlockTriangles;
  part(order_[best_axis], begin, begin + best.left_count, end);
  return best.left_count;
}

// Splits every order into the same two parts as `by`, and keeps the order within each part.
void AreaSplitter::part(const Order& by, std::uint32_t begin, std::uint32_t middle,
                        std::uint32_t end) {
  std::array<bool, kMaxAreaSplit> is_left;
  for (std::uint32_t i = begin; i < end; ++i) {
    is_left[by[i]] = i < middle;
    last_[i] = by[i];
  }
  for (Order& order : order_) {
    if (&order == &by) continue;
    Order parted;
    std::uint32_t left = begin, right = middle;
    for (std::uint32_t i = begin; i < end; ++i)
      parted[is_left[order[i]] ? left++ : right++] = order[i];
    std::copy(parted.begin() + begin, parted.begin() + end, order.begin() + begin);
  }
}

}  // namespace planetree::octree
