#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "octree/traversal/tree_view.h"

namespace planetree::octree {

/// The rim of a few caps: the border of the holes that they close. It bounds how much the caps'
/// share of winding numbers varies over a box that no cap meets.
///
/// There the share is smooth, and its gradient depends on the rim alone: by the law of Biot and
/// Savart it is at most the integral of dl / r^2 along the rim, divided by 4 pi. Edges between two
/// caps cancel each other.
///
/// threads  one at a time.
class CapRim {
 public:
  /// Maximum number of caps.
  static constexpr std::uint64_t kMaxCaps = 1024;

  /// Reads the caps of a tree. Knows nothing if there are more than kMaxCaps, or if a page or
  /// memory is missing.
  void read(const TreeInfo& caps, const PageReader& pages) noexcept;

  bool is_known() const { return !caps_.empty(); }
  std::size_t caps() const { return caps_.size(); }
  std::size_t edges() const { return edges_.size(); }

  /// Returns whether a cap may meet a box.
  ///
  /// cap           below caps()
  /// lower, upper  model frame
  bool may_meet(std::size_t cap, const Point& lower, const Point& upper) const {
    return !(caps_[cap].gap2(lower, upper) > 0);
  }
  /// Returns a bound on the difference of the caps' shares at the centre of a box and at any other
  /// of its points. No cap may meet the box. Looks at all edges.
  double variation(const Point& lower, const Point& upper) const;

 private:
  struct Box {
    Point lower, upper;
    /// Returns the square of the gap to another box.
    double gap2(const Point& other_lower, const Point& other_upper) const {
      return (lower - other_upper).cwiseMax(other_lower - upper).cwiseMax(0.0).squaredNorm();
    }
  };
  struct Edge {
    Box box;
    double weight;  ///< length times the number of times that the rim traverses it
  };
  struct Space;
  struct Free {
    void operator()(Space* space) const noexcept;
  };
  void find_edges();

  // One block, which the system gets back when a model has been opened: many small allocations
  // would stay beside the model's budget.
  std::unique_ptr<Space, Free> space_;
  std::span<const Box> caps_;
  std::span<const Edge> edges_;
};

}  // namespace planetree::octree
