#include "octree/crossings.h"

#include "octree/box_walk.h"
#include "octree/strict_math.h"

namespace planetree::octree {

Crossings count_crossings(const TreeFacts& tree, const MovedSegment& segment,
                          std::uint64_t max_nodes, PageReader pages, TreeWork& work) noexcept {
  const Point lower = segment.from.cwiseMin(segment.to);
  const Point upper = segment.from.cwiseMax(segment.to);
  Crossings count;
  BoxWalk walk(tree, lower, upper, pages, work);
  count.complete = walk.run(max_nodes, [&](const BlockView& block) {
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      const Triangle triangle = block.triangle(i);
      const auto& [a, b, c] = triangle;
      const Point least = a.cwiseMin(b).cwiseMin(c), greatest = a.cwiseMax(b).cwiseMax(c);
      if ((least.array() > upper.array()).any() || (greatest.array() < lower.array()).any())
        continue;
      ++work.triangles;
      count.on_surface = count.on_surface || lies_on(segment.from, triangle);
      count.difference += crossing(segment, triangle);
    }
  });
  return count;
}

}  // namespace planetree::octree
