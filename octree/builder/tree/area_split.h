#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "octree/builder/sort/morton_order.h"
#include "octree/geometry/child_bounds.h"

namespace planetree::octree {

inline constexpr std::uint32_t kMaxAreaSplit = 512;

/// A triangle to be split: its key and its box.
struct SplitItem {
  MortonKey key;
  FloatBox box;
};

/// Splits up to kMaxAreaSplit triangles in two, and the parts again. Each split minimises the sum
/// of surface area times number of blocks over its two parts, among all positions in the orders of
/// the three centre coordinates. Ties go to the first axis and to the position next to the middle;
/// triangles with equal coordinates are in the order of their positions. Triangles are sorted once:
/// a part of a sorted sequence is sorted.
class AreaSplitter {
 public:
  /// A box whose corners fill a vector each.
  struct WideBox {
    Eigen::Array4f lower, upper;
  };

  /// items  must outlive this.
  explicit AreaSplitter(std::span<const SplitItem> items);

  /// Splits the triangles at indices [begin, end), which are more than fit in a block. They must be
  /// all triangles, or one part of an earlier split. Returns the number of triangles in the first
  /// part.
  std::uint32_t split(std::uint32_t begin, std::uint32_t end);

  /// The triangle at an index.
  const SplitItem& at(std::uint32_t index) const { return items_[order_[0][index]]; }
  /// The triangle at an index, in the order that its last split used.
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
  std::array<Order, 3> order_;  // by axis; a part has the same triangles in each order
  Order last_;
};

}  // namespace planetree::octree
