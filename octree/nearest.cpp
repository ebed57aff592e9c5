#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/nearest.cpp"
#include <hwy/foreach_target.h>

#include "octree/nearest.h"

#include <algorithm>
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
          NearestWork& work)
      : tree_(tree),
        query_(query),
        wide_(FloatQuery::from(query.x() - tree.centre.x(), query.y() - tree.centre.y(),
                               query.z() - tree.centre.z())),
        limits_(limits),
        pages_(pages),
        work_(work),
        links_(tree.page_bytes),
        best_(query, wide_, limits) {}

  void run() {
    // An honest tree cannot be visited longer than it is; a forged one could.
    const std::uint64_t most = std::min<std::uint64_t>(limits_.max_nodes, tree_.record_count);
    std::uint64_t visits = 0;
    frontier_.push(0, 0.0f, tree_.root_link);
    while (!frontier_.empty()) {
      const Frontier::Entry entry = frontier_.pop();
      if (entry.bound > best_.threshold()) {
        pruned_ = std::min(pruned_, entry.bound);
        continue;
      }
      if (visits == most) {
        unread_ = std::min(unread_, entry.bound);
        continue;
      }
      ++visits;
      visit(entry);
    }
  }

  const BestTriangle& best() const { return best_; }
  const FloatQuery& wide() const { return wide_; }
  // Least bounds of children not visited because max_error allowed it, and
  // because they could not be read or the work was spent.
  float pruned() const { return pruned_; }
  float unread() const { return unread_; }

 private:
  HWY_INLINE void visit(const Frontier::Entry& entry) {
    const std::byte* record = find(entry.link);
    if (!record) {
      unread_ = std::min(unread_, entry.bound);
    } else if (LinkFormat::is_leaf(entry.link)) {
      ++work_.blocks;
      visit_block(BlockView(record, tree_.shape));
    } else {
      ++work_.nodes;
      visit_node(*reinterpret_cast<const Node*>(record), entry.bound);
    }
  }

  HWY_INLINE const std::byte* find(std::uint32_t link) {
    const std::uint32_t page = links_.page(link);
    const std::uint32_t slot = links_.slot(link);
    if (page != page_number_ || !frame_) {
      ++work_.page_turns;
      page_number_ = page;
      frame_ = pages_.page(pages_.context, page);
      if (!frame_) return nullptr;
      if (!leads_to_record(link, slot)) return nullptr;
    }
    return frame_ + slot * kSlotBytes;
  }

  // Links within a page were checked when it was decoded, links between pages
  // cannot be before both are here.
  bool leads_to_record(std::uint32_t link, std::uint32_t slot) const {
    const auto& header = *reinterpret_cast<const FrameHeader*>(frame_);
    if (LinkFormat::is_leaf(link)) {
      const auto* starts = reinterpret_cast<const std::uint64_t*>(frame_ + kSlotBytes);
      return (starts[slot / 64] >> slot % 64 & 1) != 0;
    }
    if (slot < header.first_node_slot) return false;
    const std::uint32_t offset = slot - header.first_node_slot;
    return offset % kNodeSlots == 0 && offset / kNodeSlots < header.node_count;
  }

  HWY_INLINE void visit_node(const Node& node, float own_bound) {
    if (!frontier_.has_room()) {
      unread_ = std::min(unread_, own_bound);
      return;
    }
    HWY_ALIGN float bounds[kFanOut];
    node_bounds(node, wide_, own_bound > node.gate, bounds);
    const std::size_t mark = frontier_.mark();
    const float threshold = best_.threshold();
    for (unsigned child = 0; child < node.child_count; ++child) {
      if (bounds[child] > threshold)
        pruned_ = std::min(pruned_, bounds[child]);
      else
        frontier_.push(mark, bounds[child], node.link[child]);
    }
  }

  HWY_INLINE void visit_block(const BlockView& block) {
    HWY_ALIGN float squared[kMaxBlockTriangles] = {};
    const Point first = block.vertex(0);
    const float local[3] = {static_cast<float>(query_.x() - first.x()),
                            static_cast<float>(query_.y() - first.y()),
                            static_cast<float>(query_.z() - first.z())};
    block_filter(block.header(), local, squared);
    const unsigned count = block.triangle_count();
    // The most promising triangle first: it usually rules the others out.
    unsigned first_choice = 0;
    for (unsigned i = 1; i < count; ++i)
      if (squared[i] < squared[first_choice]) first_choice = i;
    if (!offer(block, first_choice, squared[first_choice])) return;
    for (unsigned i = 0; i < count; ++i)
      if (i != first_choice) offer(block, i, squared[i]);
  }

  HWY_INLINE bool offer(const BlockView& block, unsigned index, float squared) {
    const float limit = filter_threshold(wide_, best_.reach(), block.header().extent);
    if (squared > limit) return false;
    ++work_.triangles;
    best_.offer(block.triangle(index), block.id(index));
    return true;
  }

  const TreeFacts& tree_;
  const Point query_;
  const FloatQuery wide_;
  const NearestLimits limits_;
  const PageReader pages_;
  NearestWork& work_;
  const LinkFormat links_;
  BestTriangle best_;
  Frontier frontier_;
  std::uint32_t page_number_ = 0;
  const std::byte* frame_ = nullptr;
  float pruned_ = std::numeric_limits<float>::infinity();
  float unread_ = std::numeric_limits<float>::infinity();
};

NearestAnswer nearest_on_target(const TreeFacts& tree, const Point& query,
                                const NearestLimits& limits, PageReader pages, NearestWork& work) {
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
                      PageReader pages, NearestWork& work) noexcept {
  assert(query.cwiseAbs().maxCoeff() <= kFarthestQuery);
  return HWY_DYNAMIC_DISPATCH(nearest_on_target)(tree, query, limits, pages, work);
}

}  // namespace planetree::octree
#endif
