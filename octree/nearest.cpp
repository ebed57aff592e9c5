#include "octree/nearest.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/nearest.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "octree/block_view.h"
#include "octree/bounds.h"
#include "octree/conclusion.h"
#include "octree/descent.h"
#include "octree/strict_math.h"
#include "octree/wide_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// One descent; the parts that touch nodes and blocks are compiled per target.
class Descent {
 public:
  Descent(const TreeFacts& tree, const Point& query, const NearestLimits& limits, PageReader pages,
          TreeWork& work)
      : tree_(tree),
        query_(query),
        wide_(FloatQuery::from(query.x() - tree.centre.x(), query.y() - tree.centre.y(),
                               query.z() - tree.centre.z())),
        limits_(limits),
        work_(work),
        records_(tree, pages),
        best_(query, wide_, limits) {}

  void run() {
    // An honest tree cannot be visited longer than it is; a forged one could.
    const std::uint64_t most = std::min<std::uint64_t>(limits_.max_nodes, tree_.record_count);
    FrontierEntry entry(0.0f, tree_.root_link);
    std::uint64_t visits = 0;
    do {
      if (visits == most) {
        unread_ = std::min(unread_, entry.bound());
      } else {
        ++visits;
        visit(entry);
      }
    } while (frontier_.pop(best_.threshold(), entry, pruned_));
  }

  const BestTriangle& best() const { return best_; }
  const FloatQuery& wide() const { return wide_; }
  // Least bounds of children not visited because max_error allowed it, and
  // because they could not be read or the work was spent.
  float pruned() const { return pruned_; }
  float unread() const { return unread_; }

 private:
  HWY_INLINE void visit(FrontierEntry entry) {
    const std::byte* record = records_.find(entry.link(), work_);
    if (!record) {
      unread_ = std::min(unread_, entry.bound());
    } else if (LinkFormat::is_leaf(entry.link())) {
      ++work_.blocks;
      visit_block(BlockView(record, tree_.shape));
    } else {
      ++work_.nodes;
      visit_node(*reinterpret_cast<const Node*>(record), entry.bound());
    }
  }

  HWY_INLINE void visit_node(const Node& node, float own_bound) {
    if (!frontier_.has_room()) {
      unread_ = std::min(unread_, own_bound);
      return;
    }
    HWY_ALIGN float bounds[kFanOut];
    unsigned near = node_bounds(node, wide_, own_bound > node.gate, best_.threshold(), bounds);
    near &= (1u << node.child_count) - 1;
    if (limits_.max_error > 0) note_pruned(node, near, bounds);
    frontier_.open_group();
    for (; near != 0; near &= near - 1) {
      const auto child = static_cast<unsigned>(std::countr_zero(near));
      frontier_.push(FrontierEntry(bounds[child], node.link[child]));
    }
  }

  void note_pruned(const Node& node, unsigned near, const float* bounds) {
    for (unsigned child = 0; child < node.child_count; ++child)
      if ((near >> child & 1) == 0) pruned_ = std::min(pruned_, bounds[child]);
  }

  HWY_INLINE void visit_block(const BlockView& block) {
    HWY_ALIGN float squared[kMaxBlockTriangles];
    const Point first = block.vertex(0);
    const float local[3] = {static_cast<float>(query_.x() - first.x()),
                            static_cast<float>(query_.y() - first.y()),
                            static_cast<float>(query_.z() - first.z())};
    float limit = limit_for(block);
    unsigned near = block_filter(block.header(), local, limit, squared);
    near &= (1u << block.triangle_count()) - 1;
    if (near == 0) return;
    // The most promising triangle first: it usually rules the others out.
    auto choice = static_cast<unsigned>(std::countr_zero(near));
    for (unsigned rest = near & (near - 1); rest != 0; rest &= rest - 1) {
      const auto at = static_cast<unsigned>(std::countr_zero(rest));
      if (squared[at] < squared[choice]) choice = at;
    }
    offer(block, choice);
    near &= ~(1u << choice);
    limit = limit_for(block);
    for (; near != 0; near &= near - 1) {
      const auto at = static_cast<unsigned>(std::countr_zero(near));
      if (squared[at] > limit) continue;
      offer(block, at);
      limit = limit_for(block);
    }
  }

  float limit_for(const BlockView& block) const {
    return filter_threshold(wide_, best_.reach(), block.header().extent);
  }

  void offer(const BlockView& block, unsigned index) {
    ++work_.triangles;
    best_.offer(block.triangle(index), block.id(index));
  }

  const TreeFacts& tree_;
  const Point query_;
  const FloatQuery wide_;
  const NearestLimits limits_;
  TreeWork& work_;
  RecordFinder records_;
  BestTriangle best_;
  Frontier frontier_;
  float pruned_ = std::numeric_limits<float>::infinity();
  float unread_ = std::numeric_limits<float>::infinity();
};

NearestAnswer nearest_on_target(const TreeFacts& tree, const Point& query,
                                const NearestLimits& limits, PageReader pages, TreeWork& work) {
  Descent descent(tree, query, limits, pages, work);
  descent.run();
  return conclude(tree, query, limits, descent.best(), descent.wide(), descent.pruned(),
                  descent.unread());
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(nearest_on_target);

NearestAnswer nearest(const TreeFacts& tree, const Point& query, const NearestLimits& limits,
                      PageReader pages, TreeWork& work) noexcept {
  assert(query.cwiseAbs().maxCoeff() <= kFarthestQuery);
  return HWY_DYNAMIC_DISPATCH(nearest_on_target)(tree, query, limits, pages, work);
}

}  // namespace planetree::octree
#endif
