#include "octree/nearest.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/nearest.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "octree/best_triangle.h"
#include "octree/block_view.h"
#include "octree/bounds.h"
#include "octree/candidates.h"
#include "octree/conclusion.h"
#include "octree/frontier.h"
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
        best_(query_, wide_, limits_) {}

  void run() {
    // An honest tree cannot be visited longer than it is; a forged one could.
    const std::uint64_t most = std::min<std::uint64_t>(limits_.max_nodes, tree_.record_count);
    FrontierEntry entry{.bound = 0, .link = tree_.root_link};
    std::uint64_t visits = 0;
    do {
      if (visits == most) {
        unread_ = std::min(unread_, entry.bound);
        continue;
      }
      ++visits;
      visit(entry);
    } while (frontier_.pop(best_.threshold(), entry, pruned_));
    settle();
  }

  const BestTriangle& best() const { return best_; }
  const FloatQuery& wide() const { return wide_; }
  // Least bounds of children not visited because max_error allowed it, and
  // because they could not be read or the work was spent.
  float pruned() const { return pruned_; }
  float unread() const { return unread_; }

 private:
  HWY_INLINE void visit(FrontierEntry entry) {
    const std::byte* record = records_.find(entry.link, work_);
    if (!record) {
      unread_ = std::min(unread_, entry.bound);
    } else if (LinkFormat::is_leaf(entry.link)) {
      ++work_.blocks;
      visit_block(entry, BlockView(record, tree_.shape));
    } else {
      ++work_.nodes;
      visit_node(entry, *reinterpret_cast<const Node*>(record));
    }
  }

  HWY_INLINE void visit_node(FrontierEntry entry, const Node& node) {
    if (!frontier_.has_room()) {
      unread_ = std::min(unread_, entry.bound);
      return;
    }
    FrontierGroup& group = frontier_.next();
    const unsigned near =
        sorted_children(node, wide_, entry.bound > node.gate, best_.threshold(), group);
    if (near < node.child_count) pruned_ = std::min(pruned_, group.entry(near).bound);
    if (near > 1) records_.prefetch(group.link[1]);
    frontier_.push(near);
  }

  HWY_INLINE void visit_block(FrontierEntry entry, const BlockView& block) {
    const BlockHeader& header = block.header();
    // Too small for float, or too far away.
    if (!wide_.usable || header.extent < kLeastFilterExtent) {
      for (unsigned i = 0; i < header.triangle_count; ++i) offer(block, i);
      return;
    }
    const Point first = block.vertex(0);
    const float local[3] = {static_cast<float>(query_.x() - first.x()),
                            static_cast<float>(query_.y() - first.y()),
                            static_cast<float>(query_.z() - first.z())};
    BlockFilter filter;
    filter_block(header, local, filter_threshold(wide_, best_.reach(), header.extent), filter);
    if (filter.near == 0) return;
    best_.promise(filter_upper(filter.least_upper, header.extent));
    const float limit = filter_threshold(wide_, best_.reach(), header.extent);
    for (unsigned near = filter.near; near != 0; near &= near - 1) {
      const auto index = static_cast<unsigned>(std::countr_zero(near));
      if (filter.squared[index] > limit) continue;
      if (candidates_.full()) make_room();
      candidates_.add({entry, index, header.extent, filter.squared[index]});
    }
  }

  void make_room() {
    candidates_.keep_if([&](const Candidate& candidate) { return may_be_best(candidate); });
    if (candidates_.full()) settle();
  }

  bool may_be_best(const Candidate& candidate) const {
    return candidate.squared <= filter_threshold(wide_, best_.reach(), candidate.extent);
  }

  // Evaluates what may be best, the most promising first: it usually rules the others out.
  void settle() {
    while (!candidates_.empty()) {
      const Candidate candidate = candidates_.take_least();
      if (!may_be_best(candidate)) continue;
      if (const std::byte* record = records_.find(candidate.block.link, work_))
        offer(BlockView(record, tree_.shape), candidate.index);
      else
        unread_ = std::min(unread_, candidate.block.bound);
    }
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
  Candidates candidates_;
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
