// Traversal of a tree to the triangles near a point, and near a segment.

#if defined(PLANETREE_OCTREE_NEAR_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_NEAR_WALK_INL_H_
#undef PLANETREE_OCTREE_NEAR_WALK_INL_H_
#else
#define PLANETREE_OCTREE_NEAR_WALK_INL_H_
#endif

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "octree/geometry/work_limit.h"
#include "octree/nearest/best_triangle.h"
#include "octree/nearest/near_triangles.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/frontier.h"
#include "octree/traversal/link_resolver.h"
#include "octree/traversal/node_kernels-inl.h"
#include "octree/traversal/segment_filter-inl.h"
#include "octree/traversal/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// What may meet a corridor, in float.
class CorridorFilter {
 public:
  CorridorFilter(const TreeInfo& tree, const Corridor& corridor)
      : nodes_(FloatSegment::between(corridor.from, corridor.to, tree.centre, 0, corridor.margin)),
        triangles_(tree, corridor.from, corridor.to, corridor.margin) {}

  unsigned children_in(const Node& node) const { return children_met(node, nodes_); }
  unsigned triangles_in(const BlockView& block) const { return triangles_.met_in(block); }

 private:
  const FloatSegment nodes_;
  const SegmentFilter triangles_;
};

// Runs one traversal, nearest child first.
//
// Visitor  reach() returns the distance from the query beyond which no triangle is wanted; it may
//          shrink. visit(block, near, work) takes the triangles of a block that have a bit in
//          `near`, and returns whether `work` sufficed. Unless it kMeasures distances, there is a
//          corridor, by which alone triangles are told apart.
template <class Visitor>
class NearWalk {
 public:
  NearWalk(const TreeInfo& tree, const Point& query, const Corridor* corridor, Visitor& visitor,
           WorkLimit& limit, const PageReader& pages, TraversalStats& work)
      : tree_(tree),
        query_(query),
        float_query_(FloatQuery::from(query, tree)),
        span_(tree.span(query)),
        visitor_(visitor),
        // At most the number of records: in a forged tree links could lead in circles.
        work_left_(limit, tree.record_count),
        work_(work),
        records_(tree, pages) {
    if (corridor) corridor_.emplace(tree, *corridor);
  }

  // Returns a lower bound on the distance of every triangle within the final reach that was not
  // visited because pages or work lacked; infinity if there is none.
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
  double reach() const { return BestTriangle::reach_within(visitor_.reach(), span_); }
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
      const BlockView block(record, tree_.shape);
      const unsigned near = near_in(block);
      if (near != 0 && !visitor_.visit(block, near, work_left_))
        unread_ = std::min(unread_, entry.bound);
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
    const bool discs = entry.bound > node.gate;
    NearChildren children{};
    if (!corridor_) {
      children = sorted_children(node, float_query_, discs, threshold(), group);
    } else if (const unsigned met = corridor_->children_in(node); met != 0) {
      children = sorted_children(node, float_query_, discs, threshold(), group, &met);
    }
    if (children.count == 0) return false;
    const std::uint32_t page = records_.page();
    frontier_.push(1, children.count, page);
    entry = {children.bound(), node.link[children.child()], page};
    return true;
  }

  // Returns a bit for each triangle of a block that may be wanted.
  unsigned near_in(const BlockView& block) const {
    if constexpr (Visitor::kMeasures) {
      const unsigned near = within_reach(block);
      return near != 0 && corridor_ ? near & corridor_->triangles_in(block) : near;
    } else {
      return corridor_->triangles_in(block);
    }
  }
  unsigned within_reach(const BlockView& block) const {
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

  const TreeInfo& tree_;
  const Point query_;
  const FloatQuery float_query_;
  const double span_;
  std::optional<CorridorFilter> corridor_;
  Visitor& visitor_;
  TraversalWork work_left_;
  TraversalStats& work_;
  LinkResolver records_;
  Frontier frontier_;
  float unread_ =
      std::numeric_limits<float>::infinity();  // least squared bound of what was skipped
};

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
