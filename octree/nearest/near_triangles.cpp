#include "octree/nearest/near_triangles.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/nearest/near_triangles.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <limits>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/triangle_kernels-inl.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/best_triangle.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/frontier.h"
#include "octree/traversal/node_kernels-inl.h"
#include "octree/traversal/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Runs one traversal. Highway compiles it once for each instruction set.
class NearTraversal {
 public:
  NearTraversal(const TreeInfo& tree, const Point& query, NearTriangleSink& sink, WorkLimit& limit,
                const PageReader& pages, TraversalStats& work)
      : tree_(tree),
        query_(query),
        float_query_(FloatQuery::from(query, tree)),
        span_(tree.span(query)),
        sink_(sink),
        // At most the number of records: in a forged tree links could lead in circles.
        work_left_(limit, tree.record_count),
        work_(work),
        records_(tree, pages) {}

  double run() {
    FrontierEntry entry{0, tree_.root_link, LinkResolver::kNoPage};
    float pruned = std::numeric_limits<float>::infinity();
    do {
      // Goes from nearest child to nearest child.
      while (visit(entry)) {
      }
    } while (frontier_.pop(Frontier::Order::kLast, threshold(), entry, pruned));
    return unread_ < std::numeric_limits<float>::infinity() && unread_ <= threshold()
               ? certified(float_query_, unread_)
               : std::numeric_limits<double>::infinity();
  }

 private:
  // A triangle's value may exceed its distance.
  double reach() const { return BestTriangle::reach_within(sink_.reach(), span_); }
  float threshold() const { return prune_threshold(float_query_, reach()); }

  // Visits a record. Returns true if a child of it is to be visited next; `entry` is then that
  // child.
  bool visit(FrontierEntry& entry) {
    const std::byte* record =
        work_left_.visit() ? records_.find(entry.link, work_, entry.from) : nullptr;
    if (!record) {
      unread_ = std::min(unread_, records_.skip(entry.bound));
    } else if (LinkFormat::is_leaf(entry.link)) {
      ++work_.blocks;
      visit_block(BlockView(record, tree_.shape), entry.bound);
    } else {
      ++work_.nodes;
      return visit_node(entry, *reinterpret_cast<const Node*>(record));
    }
    return false;
  }

  bool visit_node(FrontierEntry& entry, const Node& node) {
    // Only a corrupt tree is deeper than the format allows.
    if (!frontier_.has_capacity()) {
      unread_ = std::min(unread_, entry.bound);
      return false;
    }
    FrontierGroup& group = frontier_.next();
    const NearChildren children =
        sorted_children(node, float_query_, entry.bound > node.gate, threshold(), group);
    if (children.count == 0) return false;
    const std::uint32_t page = records_.page();
    frontier_.push(1, children.count, page);
    entry = {children.bound(), node.link[children.child()], page};
    return true;
  }

  // bound  of the block
  void visit_block(const BlockView& block, float bound) {
    const unsigned near = near_in(block);
    if (near == 0) return;
    if (!work_left_.take(WorkUnits::kNearBlock)) {
      unread_ = std::min(unread_, bound);
      return;
    }
    for (unsigned i = 0; i < kMaxBlockTriangles; ++i)
      rows_.set(i, block.triangle(near_or_first(near, i)));
    for (unsigned first = 0; first < kMaxBlockTriangles; first += kTrianglesAtOnce)
      evaluate(block, near >> first & ((1U << kTrianglesAtOnce) - 1), first, bound);
  }
  // Rows of other triangles repeat one that is near.
  static unsigned near_or_first(unsigned near, unsigned i) {
    return (near >> i & 1) != 0 ? i : static_cast<unsigned>(std::countr_zero(near));
  }

  // Returns a bit for each triangle of a block that may be within reach.
  unsigned near_in(const BlockView& block) const {
    const BlockHeader& header = block.header();
    if (can_filter(float_query_, header.extent)) {
      FilteredTriangles filtered;
      const FloatOffset from(query_, block.vertex(0));
      filter_block(header, from.at, filter_threshold(float_query_, reach(), header.extent),
                   filtered);
      return filtered.near & ((1U << header.triangle_count) - 1);
    }
    unsigned near = 0;
    for (unsigned i = 0; i < header.triangle_count; ++i)
      if (!is_beyond(block.triangle(i), query_, float_query_, reach())) near |= 1U << i;
    return near;
  }

  void evaluate(const BlockView& block, unsigned selected, unsigned first, float bound) {
    if (selected == 0) return;
    TriangleResults results;
    const TriangleView view = rows_.view(first);
    const unsigned refused = evaluate_selected(view, selected, query_, work_left_, results);
    if (refused != 0) unread_ = std::min(unread_, bound);
    for (unsigned taken = selected & ~refused; taken != 0; taken &= taken - 1) {
      const auto lane = static_cast<unsigned>(std::countr_zero(taken));
      ++work_.triangles;
      sink_.take(results.of(lane), view.triangle(lane), block.id(first + lane));
    }
  }

  const TreeInfo& tree_;
  const Point query_;
  const FloatQuery float_query_;
  const double span_;
  NearTriangleSink& sink_;
  TraversalWork work_left_;
  TraversalStats& work_;
  LinkResolver records_;
  TriangleRows<kMaxBlockTriangles> rows_;
  Frontier frontier_;
  float unread_ =
      std::numeric_limits<float>::infinity();  // least squared bound of what was skipped
};

double near_on_target(const TreeInfo& tree, const Point& query, NearTriangleSink& sink,
                      WorkLimit& limit, const PageReader& pages, TraversalStats& work) {
  return NearTraversal(tree, query, sink, limit, pages, work).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(near_on_target);

double near_triangles(const TreeInfo& tree, const Point& query, NearTriangleSink& sink,
                      WorkLimit& limit, const PageReader& pages, TraversalStats& work) noexcept {
  assert(query.cwiseAbs().maxCoeff() <= kMaxQueryCoordinate);
  return HWY_DYNAMIC_DISPATCH(near_on_target)(tree, query, sink, limit, pages, work);
}

}  // namespace planetree::octree
#endif
