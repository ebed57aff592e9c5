#include "octree/crossings.h"

#include "octree/box_walk.h"
#include "octree/outcodes.h"
#include "octree/strict_math.h"

namespace planetree::octree {

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
