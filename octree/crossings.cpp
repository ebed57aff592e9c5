#include "octree/crossings.h"

#include <array>
#include <cstdint>

#include "octree/box_walk.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

/// Which sides of a box the vertices of a block are beyond, one bit a side, as in
/// Cohen-Sutherland clipping.
class Outcodes {
 public:
  Outcodes(const BlockView& block, const Point& lower, const Point& upper)
      : corner_(block.header().corner) {
    for (unsigned i = 0; i < block.header().vertex_count; ++i) {
      const Point vertex = block.vertex(i);
      unsigned code = 0;
      for (unsigned axis = 0; axis < 3; ++axis)
        code |= static_cast<unsigned>(vertex[axis] < lower[axis]) << (2 * axis) |
                static_cast<unsigned>(vertex[axis] > upper[axis]) << (2 * axis + 1);
      code_[i] = static_cast<std::uint8_t>(code);
    }
  }

  /// Whether a triangle's box is apart from the box.
  bool apart(unsigned triangle) const {
    return (code_[corner_[0][triangle]] & code_[corner_[1][triangle]] &
            code_[corner_[2][triangle]]) != 0;
  }

 private:
  const std::uint8_t (&corner_)[3][kMaxBlockTriangles];
  std::array<std::uint8_t, kMaxBlockVertices> code_;
};

}  // namespace

Crossings count_crossings(const TreeFacts& tree, const MovedSegment& segment,
                          std::uint64_t max_nodes, PageReader pages, TreeWork& work) noexcept {
  const Point lower = segment.from.cwiseMin(segment.to);
  const Point upper = segment.from.cwiseMax(segment.to);
  Crossings count;
  BoxWalk walk(tree, lower, upper, pages, work);
  count.complete = walk.run(max_nodes, [&](const BlockView& block) {
    const Outcodes outcodes(block, lower, upper);
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      if (outcodes.apart(i)) continue;
      const Triangle triangle = block.triangle(i);
      ++work.triangles;
      count.on_surface = count.on_surface || lies_on(segment.from, triangle);
      count.difference += crossing(segment, triangle);
    }
  });
  return count;
}

}  // namespace planetree::octree
