#include "octree/winding/crossings.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/winding/crossings.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/geometry/work_limit.h"
#include "octree/traversal/link_resolver.h"
#include "octree/traversal/segment_filter-inl.h"
#include "octree/traversal/segment_kernels-inl.h"
#include "octree/traversal/tree_view.h"
#include "octree/traversal/tree_walk.h"
#include "octree/winding/crossing_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Sums crossings. It gathers triangles until there are as many as are tested at once.
class CrossingSum {
 public:
  CrossingSum(const PerturbedSegment& segment, WorkLimit& limit)
      : segment_(segment), limit_(limit) {}

  void add(const Triangle& triangle, bool is_cap) {
    caps_ |= static_cast<unsigned>(is_cap) << size_;
    if (size_ == 0)
      rows_.fill(0, triangle);
    else
      rows_.set(size_, triangle);
    if (++size_ == kTrianglesAtOnce) test();
  }

  // Not complete if the limit refused a test.
  Crossings sum() {
    if (size_ > 0) test();
    sum_.complete = !limit_.exceeded();
    return sum_;
  }

 private:
  void test() {
    const unsigned used = (1U << size_) - 1, caps = caps_;
    size_ = 0;
    caps_ = 0;
    if (!limit_.take()) return;
    const CrossedTriangles crossed = cross_triangles(rows_, segment_);
    sum_.difference += std::popcount(crossed.forward & used);
    sum_.difference -= std::popcount(crossed.backward & used);
    for (unsigned unsure = crossed.unsure & used; unsure != 0; unsure &= unsure - 1) {
      if (!limit_.take(WorkUnits::kExactCrossing)) return;
      const auto at = static_cast<unsigned>(std::countr_zero(unsure));
      add_exactly(rows_.triangle(at), (caps >> at & 1) != 0);
    }
  }

  // Many triangles may coincide; only the first of them is tested.
  void add_exactly(const Triangle& triangle, bool is_cap) {
    if (triangle != tested_ || is_cap != tested_is_cap_) {
      sum_.on_surface = sum_.on_surface || (!is_cap && lies_on(segment_.from, triangle, &limit_));
      tested_is_cap_ = is_cap;
      tested_crossing_ = crossing(segment_, triangle, &limit_);
      tested_ = triangle;
    }
    sum_.difference += tested_crossing_;
  }

  const PerturbedSegment& segment_;
  WorkLimit& limit_;
  std::size_t size_ = 0;
  unsigned caps_ = 0;  // which of the rows are caps, one bit each
  TriangleRows<kTrianglesAtOnce> rows_;
  Crossings sum_;
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  // The last triangle tested by exact signs.
  Triangle tested_{Point::Constant(kNone), Point::Constant(kNone), Point::Constant(kNone)};
  bool tested_is_cap_ = false;
  int tested_crossing_ = 0;
};

// Counts the crossings of a segment with the triangles of the blocks that are visited.
class BlockCrossings {
 public:
  BlockCrossings(const TreeInfo& tree, const PerturbedSegment& segment, WorkLimit& limit,
                 TraversalStats& work)
      : filter_(tree, segment.from, segment.to), crossings_(segment, limit), work_(work) {}

  void visit(const BlockView& block, bool is_of_caps) {
    unsigned met = filter_.met_in(block);
    for (; met != 0; met &= met - 1) {
      crossings_.add(block.triangle(static_cast<unsigned>(std::countr_zero(met))), is_of_caps);
      ++work_.triangles;
    }
  }

  Crossings found(bool complete) {
    Crossings found = crossings_.sum();
    found.complete = found.complete && complete;
    return found;
  }

 private:
  const SegmentFilter filter_;
  CrossingSum crossings_;
  TraversalStats& work_;
};

Crossings count_on_target(const TreeInfo& tree, const PerturbedSegment& segment,
                          std::uint64_t max_work, const PageReader& pages, TraversalStats& work) {
  const FloatSegment node_segment = FloatSegment::between(segment.from, segment.to, tree.centre, 0);
  WorkLimit limit(work.units, max_work);
  BlockCrossings crossings(tree, segment, limit, work);
  const auto meeting = [&](const Node& node) HWY_ATTR { return children_met(node, node_segment); };
  const auto walk = [&](const TreeInfo& walked, bool is_of_caps) {
    const auto visit = [&](const BlockView& block, std::uint32_t)
                           HWY_ATTR { crossings.visit(block, is_of_caps); };
    return TreeWalk(walked, pages, work).run(limit.left(), visit, meeting);
  };
  bool complete = walk(tree, false);
  if (tree.caps && complete) complete = walk(*tree.caps, true);
  return crossings.found(complete);
}

Crossings count_in_blocks_on_target(const TreeInfo& tree, const PerturbedSegment& segment,
                                    std::span<const std::uint32_t> blocks, std::uint64_t max_work,
                                    const PageReader& pages, TraversalStats& work) {
  WorkLimit limit(work.units, max_work);
  if (!limit.take(blocks.size())) return {.complete = false};
  LinkResolver records(tree, pages);
  const LinkFormat links = LinkFormat::numbered(tree.page_bytes);
  records.prefetch_numbered(blocks);
  BlockCrossings crossings(tree, segment, limit, work);
  bool complete = true;
  for (const std::uint32_t link : blocks) {
    const std::byte* record = records.find_numbered(link, work);
    complete = complete && record;
    if (!record) continue;
    ++work.blocks;
    crossings.visit(BlockView(record, tree.shape), tree.is_of_caps(links.page(link)));
  }
  return crossings.found(complete);
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(count_on_target);
HWY_EXPORT(count_in_blocks_on_target);

Crossings count_crossings(const TreeInfo& tree, const PerturbedSegment& segment,
                          std::uint64_t max_work, const PageReader& pages,
                          TraversalStats& work) noexcept {
  return HWY_DYNAMIC_DISPATCH(count_on_target)(tree, segment, max_work, pages, work);
}

Crossings count_crossings(const TreeInfo& tree, const PerturbedSegment& segment,
                          std::span<const std::uint32_t> blocks, std::uint64_t max_work,
                          const PageReader& pages, TraversalStats& work) noexcept {
  return HWY_DYNAMIC_DISPATCH(count_in_blocks_on_target)(tree, segment, blocks, max_work, pages,
                                                         work);
}

}  // namespace planetree::octree
#endif
