// Traversal of a tree to the triangle nearest to a query.

#if defined(PLANETREE_OCTREE_NEAREST_TRAVERSAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLANETREE_OCTREE_NEAREST_TRAVERSAL_INL_H_
#undef PLANETREE_OCTREE_NEAREST_TRAVERSAL_INL_H_
#else
#define PLANETREE_OCTREE_NEAREST_TRAVERSAL_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "octree/geometry/triangle_kernels-inl.h"
#include "octree/geometry/work_limit.h"
#include "octree/nearest/best_triangle.h"
#include "octree/nearest/candidates-inl.h"
#include "octree/nearest/coherence_cache.h"
#include "octree/nearest/nearby_kernels-inl.h"
#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/frontier.h"
#include "octree/traversal/link_resolver.h"
#include "octree/traversal/node_kernels-inl.h"
#include "octree/traversal/triangle_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Runs one traversal. Highway compiles it once for each instruction set.
class NearestTraversal {
 public:
  NearestTraversal(const TreeInfo& tree, const Point& query, const NearestLimits& limits,
                   WorkLimit& work_limit, const PageReader& pages, TraversalStats& work)
      : tree_(tree),
        query_(query),
        float_query_(FloatQuery::from(query, tree)),
        limits_(limits),
        // At most the number of records: in a forged tree links could lead in circles.
        work_left_(work_limit, tree.record_count),
        work_(work),
        release_hook_(limits.may_depend_on_pages() ? pages.release_hook : nullptr),
        records_(tree, pages),
        best_(float_query_, limits_, tree.span(query)) {
    if (release_hook_) *release_hook_ = {this, &on_release};
  }
  ~NearestTraversal() {
    if (release_hook_) *release_hook_ = {};
  }
  NearestTraversal(const NearestTraversal&) = delete;
  NearestTraversal& operator=(const NearestTraversal&) = delete;

  void run_from_root(double within) {
    best_.limit(BestTriangle::reach_within(within, tree_.span(query_)));
    search(0, tree_.root_link);
    finish();
  }
  // Starts at the ball's subtrees, nearest first.
  void run_from(const CoherenceCache& coherence_cache) {
    subtrees_ = &coherence_cache.subtrees();
    if (limits_.max_error == 0 && float_query_.usable)
      best_.tighten(coherence_cache.nearest_of(query_));
    SubtreeKeys keys;
    find_near(*subtrees_, float_query_, best_.exact_threshold(), keys);
    for (std::size_t i = 0; i < keys.size(); ++i) {
      if (keys.bound(i) > best_.threshold()) {
        skipped_.pruned = std::min(skipped_.pruned, keys.bound(i));
        break;
      }
      search(keys.bound(i), subtrees_->link(keys.index(i)));
    }
    finish();
  }

  // Evaluates the triangle of an earlier answer if an unread subtree may hold a nearer one than
  // the best so far.
  void fall_back_on(const NearestAnswer& known) {
    if (known.triangle == kNoTriangle || skipped_.unread > best_.exact_threshold()) return;
    add_candidate(known.corners, known.triangle, 0, known.is_height_field, 0);
    settle();
  }

  const BestTriangle& best() const { return best_; }
  const FloatQuery& float_query() const { return float_query_; }
  const SkippedBounds& skipped_bounds() const { return skipped_; }

 private:
  static constexpr unsigned kPrefetched = 3;     // children of a node, nearest first
  static constexpr unsigned kMaxBoxLookups = 4;  // skipped records whose boxes are looked up

  // Visits everything near in a subtree. Not inlined: it is large and has two callers.
  HWY_NOINLINE void search(float bound, std::uint32_t link) {
    FrontierEntry entry{bound, link, LinkResolver::kNoPage}, second{};
    bool has_second = false;
    do {
      // Goes from nearest child to nearest child while nodes are near.
      while (visit(entry)) {
      }
    } while (take_next(entry, second, has_second));
  }

  // Takes the next entry from the frontier. Far from the surface, two are taken at a time, since
  // few children of the first are nearer than the second.
  HWY_INLINE bool take_next(FrontierEntry& entry, FrontierEntry& second, bool& has_second) {
    if (std::exchange(has_second, false)) {
      entry = second;
      return true;
    }
    const Frontier::Order order = order_;
    const float threshold = threshold_for(order);
    if (!frontier_.pop(order, threshold, entry, skipped_.pruned)) return false;
    if (order == Frontier::Order::kNearest && frontier_.is_ordered())
      has_second = frontier_.pop(order, threshold, second, skipped_.pruned);
    return true;
  }

  // Near the surface an allowed error saves little.
  HWY_INLINE float threshold_for(Frontier::Order order) {
    return order == Frontier::Order::kNearest ? best_.threshold() : best_.exact_threshold();
  }

  // Visits a record. Returns true if a child of it is to be visited next; `entry` is then that
  // child.
  HWY_INLINE bool visit(FrontierEntry& entry) {
    if (!work_left_.visit()) {
      skipped_.unread = std::min(skipped_.unread, entry.bound);
      return false;
    }
    // Without a release hook, the frame of these blocks may be gone after the next lookup.
    if (!release_hook_ && !blocks_.empty() && !records_.is_in_current_page(entry.link))
      add_candidates_of_blocks();
    const std::byte* record = records_.find(entry.link, work_, entry.from);
    if (!record) {
      skip(entry);
    } else if (LinkFormat::is_leaf(entry.link)) {
      ++work_.blocks;
      visit_block(BlockView(record, tree_.shape), entry.bound);
    } else {
      ++work_.nodes;
      return visit_node(entry, *reinterpret_cast<const Node*>(record), records_.page());
    }
    return false;
  }

  // Skips a record whose page is missing. The box that its parent stores still bounds the distance
  // from above.
  void skip(const FrontierEntry& entry) {
    skipped_.unread = std::min(skipped_.unread, records_.skip(entry.bound));
    if (box_lookups_ == kMaxBoxLookups || !work_left_.take(WorkUnits::kParentSearch)) return;
    ++box_lookups_;
    if (entry.from == LinkResolver::kNoPage) return skip_subtree_of_ball(entry.link);
    const LinkResolver::Child child = records_.find_parent(entry.link, entry.from);
    if (child.node)
      skipped_.bound_above(child_box(*child.node, child.index), query_ - tree_.centre);
  }

  // Skips a subtree of the ball, whose box is in the list. The root is skipped here too, but it
  // has no box in the list.
  void skip_subtree_of_ball(std::uint32_t link) {
    for (std::size_t i = 0; subtrees_ && i < subtrees_->size(); ++i)
      if (subtrees_->link(i) == link)
        skipped_.within = std::min(skipped_.within, subtrees_->farthest(i, query_ - tree_.centre));
  }

  HWY_INLINE bool visit_node(FrontierEntry& entry, const Node& node, std::uint32_t page) {
    if (!frontier_.has_capacity()) {
      skipped_.unread = std::min(skipped_.unread, entry.bound);
      return false;
    }
    FrontierGroup& group = frontier_.next();
    // Far from the surface, bounds say little about where the nearest triangle is.
    const bool far = entry.bound > node.gate;
    order_ = far ? Frontier::Order::kNearest : Frontier::Order::kLast;
    const NearChildren children =
        sorted_children(node, float_query_, far, threshold_for(order_), group);
    const unsigned near = children.count;
    // Selected without a branch.
    const float first_left = group.bound(near % kFanOut);
    skipped_.pruned =
        std::min(skipped_.pruned,
                 near < node.child_count ? first_left : std::numeric_limits<float>::infinity());
    // The nearest child is visited next unless the query is far away: a child of another node may
    // then be nearer. Only far queries read the last lines of a node, which hold the discs.
    if (near > 0) {
      const std::uint32_t nearest = node.link[children.child()];
      far ? prefetch<kNodeSlots>(nearest, group, near)
          : prefetch<kNearNodeSlots>(nearest, group, near);
    }
    if (limits_.has_little_work() && near > 0 && !best_.is_limited())
      skipped_.bound_above(child_box(node, children.child()), query_ - tree_.centre);
    const bool is_next = !far && near > 0;
    frontier_.push(is_next ? 1 : 0, near, page);
    if (is_next) entry = {children.bound(), node.link[children.child()], page};
    return is_next;
  }

  // Prefetches the nearest of the near children. Where there are fewer than kPrefetched, it
  // prefetches the first of the group again, which takes no branch. `nearest` is passed by itself
  // because it is known before the children are sorted.
  template <std::size_t kNodeLines>
  HWY_INLINE void prefetch(std::uint32_t nearest, const FrontierGroup& group, unsigned near) {
    records_.prefetch<kNodeLines>(nearest);
#pragma GCC unroll 4
    for (unsigned i = 1; i < kPrefetched; ++i)
      records_.prefetch<kNodeLines>(group.link[i < near ? i : 0]);
  }

  // bound  of the block
  HWY_INLINE void visit_block(const BlockView& block, float bound) {
    const BlockHeader& header = block.header();
    if (!can_filter(float_query_, header.extent)) return visit_unfiltered(block, bound);
    if (blocks_.full()) add_candidates_of_blocks();
    const FloatOffset from(query_, block.vertex(0));
    FilteredTriangles& filtered = blocks_.next();
    filter_block(header, from.at, filter_limit(header.extent), filtered);
    if (filtered.near == 0) return;
    if (header.vertex_count() <= 3) [[unlikely]] {
      filtered.near &= (1U << different(block)) - 1;
      if (filtered.near == 0) return;
    }
    if (!may_evaluate(bound)) return;
    blocks_.add(header);
    best_.tighten(filter_upper(filtered.min_upper, header.extent));
  }

  // Returns how many triangles of a block to consider. Of equal ones the first suffices, and none
  // is needed if it is the best triangle again.
  HWY_NOINLINE unsigned different(const BlockView& block) const {
    if (!block.header().repeats_one_triangle()) return block.triangle_count();
    const auto corners = block.header().corners(0);
    const auto corner = [&](std::size_t k) { return block.vertex(corners[k]); };
    return best_.repeats(corner, block.id(0)) ? 0 : 1;
  }

  // Charges the evaluation of a block's triangles. Returns false if the work does not suffice; the
  // block then counts as unread.
  HWY_INLINE bool may_evaluate(float bound) {
    if (!work_left_.take(WorkUnits::kNearBlock)) [[unlikely]] {
      skipped_.unread = std::min(skipped_.unread, bound);
      return false;
    }
    pending_bound_ = std::min(pending_bound_, bound);
    return true;
  }

  // Visits a block that is too small or too large for float, or too far away.
  HWY_NOINLINE void visit_unfiltered(const BlockView& block, float bound) {
    const BlockHeader& header = block.header();
    const unsigned count = header.vertex_count() <= 3 ? different(block) : header.triangle_count;
    unsigned near = 0;
    for (unsigned i = 0; i < count; ++i)
      if (!is_beyond(block.triangle(i), query_, float_query_, best_.reach())) near |= 1U << i;
    if (near == 0 || !may_evaluate(bound)) return;
    for (; near != 0; near &= near - 1)
      add_candidate(block, static_cast<unsigned>(std::countr_zero(near)), 0);
  }

  // Filter values above this belong to triangles that cannot be nearest.
  float filter_limit(float extent) const {
    return filter_threshold(float_query_, best_.reach(), extent);
  }

  // Adds those triangles of the collected blocks to the candidates that float cannot rule out.
  void add_candidates_of_blocks() {
    blocks_.take_near(
        tree_.shape, [&](float extent) { return filter_limit(extent); },
        [&](const BlockView& block, unsigned i, float squared) {
          add_candidate(block, i, squared);
        });
  }

  void add_candidate(const BlockView& block, unsigned i, float squared) {
    add_candidate(block.triangle(i), block.id(i), block.header().extent,
                  block.header().is_height_field(), squared);
  }
  void add_candidate(const Triangle& corners, std::uint64_t id, float extent, bool is_height_field,
                     float squared) {
    if (candidates_.full()) {
      keep_possible();
      if (candidates_.full()) settle();
    }
    candidates_.add(corners, id, extent, is_height_field, squared);
  }

  void keep_possible() {
    candidates_.keep_if(
        [&](float squared, float extent) { return squared <= filter_limit(extent); });
  }

  // Takes the candidates of the collected blocks, whose frames are about to be released.
  static void on_release(void* traversal) noexcept {
    static_cast<NearestTraversal*>(traversal)->add_candidates_of_blocks();
  }

  void finish() {
    add_candidates_of_blocks();
    settle();
  }

  // Evaluates the candidates that may be best.
  void settle() {
    // Up to kTrianglesAtOnce candidates take as long as one.
    if (candidates_.size() > kTrianglesAtOnce) keep_possible();
    const auto& rows = candidates_.rows();
    for (std::size_t i = 0; i < candidates_.size(); i += kTrianglesAtOnce) {
      TriangleResults results;
      const std::size_t count = std::min(candidates_.size() - i, kTrianglesAtOnce);
      const unsigned all = (1U << count) - 1;
      const unsigned refused = evaluate_selected(rows.view(i), all, query_, work_left_, results);
      if (refused != 0) [[unlikely]]
        skipped_.unread = std::min(skipped_.unread, pending_bound_);
      for (std::size_t lane = 0; lane < count; ++lane) {
        if ((refused >> lane & 1) != 0) continue;
        best_.offer(results.of(lane), candidates_.id(i + lane),
                    candidates_.is_height_field(i + lane),
                    [&](Triangle& to) { rows.view(0).copy_triangle(i + lane, to); });
      }
    }
    work_.triangles += candidates_.size();
    candidates_.clear();
  }

  const TreeInfo& tree_;
  const Point query_;
  const FloatQuery float_query_;
  const NearestLimits limits_;
  TraversalWork work_left_;
  TraversalStats& work_;
  FrameReleaseHook* const release_hook_;
  LinkResolver records_;
  BestTriangle best_;
  FilteredBlocks blocks_;  // without a release hook, all in the page found last
  Candidates candidates_;
  Frontier frontier_;
  Frontier::Order order_ = Frontier::Order::kLast;
  const NearbySubtrees* subtrees_ = nullptr;  // those of a ball; null if the root is the start
  SkippedBounds skipped_;
  float pending_bound_ = std::numeric_limits<float>::infinity();  // of blocks with candidates
  unsigned box_lookups_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#endif
