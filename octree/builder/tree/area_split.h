#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "octree/builder/sort/morton_order.h"
#include "octree/geometry/child_bounds.h"

namespace planetree::octree {

inline constexpr std::uint32_t kMaxAreaSplit = 512;

/// A triangle about to be split off: its key and its box.
struct SplitItem {
  MortonKey key;
  FloatBox box;
};

/// Splits up to kMaxAreaSplit triangles again and again, each time at the least surface area
/// times triangle blocks, over all places in the orders of the three centre coordinates. Ties
/// go to the first axis and the place next to the middle, equal coordinates to the lesser
/// position. Triangles are sorted once: a half of a sorted sequence is sorted.
class AreaSplitter {
 public:
  /// A box whose sides fill a vector each.
  struct WideBox {
    Eigen::Array4f lower, upper;
  };

  /// items  used while this lives.
  explicit AreaSplitter(std::span<const SplitItem> items);

  /// Parts the triangles at places [begin, end), more than a block's, which all were or one part
  /// of what was split before; returns how many come first then.
  std::uint32_t split(std::uint32_t begin, std::uint32_t end);

  /// The triangle at a place.
  const SplitItem& at(std::uint32_t index) const { return items_[order_[0][index]]; }
  /// Indices in the order that the last split sorted them by.
  const SplitItem& in_split_order(std::uint32_t index) const { return items_[last_[index]]; }

 private:
  using Order = std::array<std::uint16_t, kMaxAreaSplit>;
  struct Split {
    float cost;
    std::uint32_t left_count;
  };

  void sort(std::size_t axis);
  Split best_on(const Order& order, std::uint32_t begin, std::uint32_t end) const;
  void part(const Order& by, std::uint32_t begin, std::uint32_t middle, std::uint32_t end);

  const std::span<const SplitItem> items_;
  std::array<WideBox, kMaxAreaSplit> boxes_;
  std::array<Order, 3> order_;  // by axis; the same triangles at the places of a part
  Order last_;
};

}  // namespace planetree::octree
