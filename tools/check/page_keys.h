#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "octree/geometry/octcode.h"
#include "octree/geometry/triangle_distance.h"

namespace planetree::tools {

/// Finds the octcodes that the pages of a tree must have: the least of those of their subtrees. A
/// subtree has the octcode of the smallest cell with the centres of all triangles below it.
///
/// memory  24 bytes for each subtree
class PageKeys {
 public:
  /// Morton codes of some triangles.
  struct CodeRange {
    std::uint64_t least = ~std::uint64_t{0}, greatest = 0;
    void add(std::uint64_t code) {
      least = std::min(least, code);
      greatest = std::max(greatest, code);
    }
  };

  /// lower  least corner of the core, model frame
  PageKeys(const octree::Point& lower, std::uint32_t first_page) : lower_(lower) {
    add_subtree(first_page);
  }

  /// Adds a subtree. The first one is that of the tree's root, which the constructor adds.
  std::uint32_t add_subtree(std::uint32_t page) {
    subtrees_.push_back({page, {}});
    return static_cast<std::uint32_t>(subtrees_.size() - 1);
  }
  /// Adds triangles that are below a subtree.
  void add(std::uint32_t subtree, const CodeRange& range) {
    subtrees_[subtree].range.add(range.least);
    subtrees_[subtree].range.add(range.greatest);
  }
  std::uint64_t code_of(const octree::Triangle& triangle) const {
    constexpr double kCells = 1 << (octree::kLevels - 1), kLast = (1 << octree::kLevels) - 1;
    std::uint32_t at[3];
    for (int axis = 0; axis < 3; ++axis) {
      const auto [least, greatest] =
          std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
      const double cell = std::floor(((least + greatest) * 0.5 - lower_[axis]) * kCells);
      at[axis] = static_cast<std::uint32_t>(std::clamp(cell, 0.0, kLast));
    }
    return octree::morton_code(at[0], at[1], at[2]);
  }

  /// Calls visit(page, octcode) for each page of the tree.
  template <class Visit>
  void for_each_page(const Visit& visit) {
    std::sort(subtrees_.begin(), subtrees_.end(), [](const Subtree& a, const Subtree& b) {
      return a.page != b.page ? a.page < b.page : octcode_of(a) < octcode_of(b);
    });
    for (std::size_t i = 0; i < subtrees_.size(); ++i)
      if (i == 0 || subtrees_[i - 1].page != subtrees_[i].page)
        visit(subtrees_[i].page, octcode_of(subtrees_[i]));
  }

 private:
  struct Subtree {
    std::uint32_t page;
    CodeRange range;
  };
  static std::uint64_t octcode_of(const Subtree& subtree) {
    return octree::octcode_of_range(subtree.range.least, subtree.range.greatest);
  }

  octree::Point lower_;
  std::vector<Subtree> subtrees_;
};

}  // namespace planetree::tools
