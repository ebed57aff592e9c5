#include "octree/crossings.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/crossings.cpp"
#include <hwy/foreach_target.h>

#include <bit>

#include "octree/box_walk.h"
#include "octree/crossing_kernels-inl.h"
#include "octree/node_kernels-inl.h"
#include "octree/outcodes.h"
#include "octree/strict_math.h"
#include "octree/triangle_rows.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Gathers triangles until there are as many as are tested at once.
class CrossingSum {
 public:
  explicit CrossingSum(const MovedSegment& segment) : segment_(segment) {}

  void add(const Triangle& triangle) {
    if (size_ == 0)
      rows_.fill(0, triangle);
    else
      rows_.set(size_, triangle);
    if (++size_ == kTrianglesAtOnce) test();
  }

  Crossings sum() {
    if (size_ > 0) test();
    return sum_;
  }

 private:
  void test() {
    const unsigned used = (1U << size_) - 1;
    const CrossedTriangles crossed = cross_triangles(rows_, segment_);
    sum_.difference += std::popcount(crossed.forward & used);
    sum_.difference -= std::popcount(crossed.backward & used);
    for (unsigned unsure = crossed.unsure & used; unsure != 0; unsure &= unsure - 1) {
      const Triangle triangle = rows_.triangle(static_cast<unsigned>(std::countr_zero(unsure)));
      sum_.on_surface = sum_.on_surface || lies_on(segment_.from, triangle);
      sum_.difference += crossing(segment_, triangle);
    }
    size_ = 0;
  }

  const MovedSegment& segment_;
  std::size_t size_ = 0;
  TriangleRows<kTrianglesAtOnce> rows_;
  Crossings sum_;
};

Crossings count_on_target(const TreeFacts& tree, const MovedSegment& segment,
                          std::uint64_t max_nodes, PageReader pages, TreeWork& work) {
  const Point lower = segment.from.cwiseMin(segment.to);
  const Point upper = segment.from.cwiseMax(segment.to);
  const Outcodes outcodes(lower, upper);
  CrossingSum crossings(segment);
  BoxWalk walk(tree, lower, upper, pages, work);
  const auto visit = [&](const BlockView& block) {
    for (unsigned near = outcodes.meeting(block); near != 0; near &= near - 1) {
      crossings.add(block.triangle(static_cast<unsigned>(std::countr_zero(near))));
      ++work.triangles;
    }
  };
  const bool complete = walk.run(max_nodes, visit,
                                 [](const Node& node, const FloatBox& box)
                                     HWY_ATTR { return meeting_children(node, box); });
  Crossings found = crossings.sum();
  found.complete = complete;
  return found;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(count_on_target);

Crossings count_crossings(const TreeFacts& tree, const MovedSegment& segment,
                          std::uint64_t max_nodes, PageReader pages, TreeWork& work) noexcept {
  return HWY_DYNAMIC_DISPATCH(count_on_target)(tree, segment, max_nodes, pages, work);
}

}  // namespace planetree::octree
#endif
