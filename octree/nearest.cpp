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
#include "octree/triangle_kernels-inl.h"
#include "octree/vicinity.h"
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
        best_(wide_, limits_) {}

  void run_from_root() {
    visit({.bound = 0, .link = tree_.root_link}, 0);
    run();
  }
  void run_from(const Node& front) {
    visit_node({.bound = 0, .link = 0}, front);
    run();
  }

  const BestTriangle& best() const { return best_; }
  const FloatQuery& wide() const { return wide_; }
  // Least bounds of children not visited because max_error allowed it, and
  // because they could not be read or the work was spent.
  float pruned() const { return pruned_; }
  float unread() const { return unread_; }

 private:
  void run() {
    std::uint64_t visits = 1;
    FrontierEntry entry;
    while (frontier_.pop(best_.threshold(), entry, pruned_)) visit(entry, visits++);
    settle();
  }

  HWY_INLINE void visit(FrontierEntry entry, std::uint64_t visits) {
    // An honest tree cannot be visited longer than it is; a forged one could.
    if (visits >= limits_.max_nodes || visits >= tree_.record_count) {
      unread_ = std::min(unread_, entry.bound);
      return;
    }
    const std::byte* record = records_.find(entry.link, work_);
    if (!record) {
      unread_ = std::min(unread_, entry.bound);
    } else if (LinkFormat::is_leaf(entry.link)) {
      ++work_.blocks;
      visit_block(BlockView(record, tree_.shape));
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
    if (near > 2) records_.prefetch(group.link[2]);
    frontier_.push(near);
  }

  HWY_INLINE void visit_block(const BlockView& block) {
    const BlockHeader& header = block.header();
    // Too small for float, or too far away.
    if (!wide_.usable || header.extent < kLeastFilterExtent) {
      for (unsigned i = 0; i < header.triangle_count; ++i) note(block, i, 0);
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
    for (unsigned near = filter.near & near_triangles(filter, limit); near != 0; near &= near - 1) {
      const auto index = static_cast<unsigned>(std::countr_zero(near));
      note(block, index, filter.squared[index]);
    }
  }

  void note(const BlockView& block, unsigned index, float squared) {
    if (candidates_.full()) {
      keep_possible();
      if (candidates_.full()) settle();
    }
    candidates_.add(block.triangle(index), block.id(index), block.header().extent, squared);
  }

  void keep_possible() {
    candidates_.keep_if([&](float squared, float extent) {
      return squared <= filter_threshold(wide_, best_.reach(), extent);
    });
  }

  // Evaluates what may be best.
  void settle() {
    keep_possible();
    candidates_.pad();
    const auto& rows = candidates_.rows();
    for (std::size_t i = 0; i < candidates_.size(); i += kTrianglesAtOnce) {
      TriangleFindings findings;
      unsigned flat = evaluate_triangles(rows.at[0][0] + i, Candidates::kMost, query_, findings);
      const std::size_t count = std::min(candidates_.size() - i, kTrianglesAtOnce);
      for (flat &= (1u << count) - 1; flat != 0; flat &= flat - 1) {
        const auto lane = static_cast<unsigned>(std::countr_zero(flat));
        refine_flat(query_, rows.triangle(i + lane), findings, lane);
      }
      for (std::size_t lane = 0; lane < count; ++lane)
        best_.offer(findings.of(lane), candidates_.id(i + lane),
                    [&] { return rows.triangle(i + lane); });
    }
    work_.triangles += candidates_.size();
    candidates_.clear();
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

// Fills the front of a ball: from the root down, the largest subtree first, as long as
// there is room for its children.
class VicinitySearch {
 public:
  VicinitySearch(const TreeFacts& tree, const Point& query, double radius, PageReader pages,
                 TreeWork& work, Node& front)
      : wide_(FloatQuery::from(query.x() - tree.centre.x(), query.y() - tree.centre.y(),
                               query.z() - tree.centre.z())),
        threshold_(prune_threshold(wide_, radius)),
        records_(tree, pages),
        work_(work),
        front_(front) {}

  // False where there is nothing to keep.
  bool run(std::uint32_t root_link) {
    front_.child_count = 0;
    front_.gate = std::numeric_limits<float>::infinity();
    if (LinkFormat::is_leaf(root_link) || !open(root_link, 0)) return false;
    for (unsigned at; (at = largest()) < front_.child_count;)
      if (!open(front_.link[at], at)) closed_ |= 1u << at;
    return front_.child_count > 0;
  }

 private:
  // The largest subtree that may still be opened.
  unsigned largest() const {
    unsigned best = kFanOut;
    for (unsigned at = 0; at < front_.child_count; ++at) {
      if ((closed_ >> at & 1) != 0 || LinkFormat::is_leaf(front_.link[at])) continue;
      if (best == kFanOut || size_[at] > size_[best]) best = at;
    }
    return best;
  }

  // Puts a node's near children in its place. False, and nothing changed, where there is no
  // room for them or the page is lost.
  bool open(std::uint32_t link, unsigned place) {
    const std::byte* record = records_.find(link, work_);
    if (!record) return false;
    ++work_.nodes;
    const Node& node = *reinterpret_cast<const Node*>(record);
    unsigned near = near_children(node, wide_, threshold_);
    const unsigned others = front_.child_count - (front_.child_count > 0 ? 1u : 0u);
    if (others + static_cast<unsigned>(std::popcount(near)) > kFanOut) return false;
    if (near == 0) return remove(place);
    for (bool first = true; near != 0; near &= near - 1, first = false) {
      const bool here = first && front_.child_count > 0;
      put(node, static_cast<unsigned>(std::countr_zero(near)), here ? place : front_.child_count++);
    }
    return true;
  }

  bool remove(unsigned place) {
    const unsigned last = --front_.child_count;
    closed_ = (closed_ & ~(1u << place)) | (closed_ >> last & 1) << place;
    closed_ &= ~(1u << last);
    put(front_, last, place);
    return true;
  }

  void put(const Node& from, unsigned child, unsigned place) {
    float diagonal2 = 0;
    for (unsigned axis = 0; axis < 3; ++axis) {
      front_.lower[axis][place] = from.lower[axis][child];
      front_.upper[axis][place] = from.upper[axis][child];
      const float side = from.upper[axis][child] - from.lower[axis][child];
      diagonal2 += side * side;
    }
    front_.link[place] = from.link[child];
    size_[place] = diagonal2;
  }

  const FloatQuery wide_;
  const float threshold_;
  RecordFinder records_;
  TreeWork& work_;
  Node& front_;
  float size_[kFanOut];
  unsigned closed_ = 0;
};

void renew(Vicinity& vicinity, const TreeFacts& tree, const Point& query, double distance,
           PageReader pages, TreeWork& work) {
  const double diagonal = (tree.box_upper - tree.box_lower).norm();
  const double radius = vicinity.wanted_radius(query, distance, diagonal);
  if (!(radius > 0)) return;
  Node& front = vicinity.begin(query, radius);
  if (!VicinitySearch(tree, query, radius, pages, work, front).run(tree.root_link))
    vicinity.forget();
}

NearestAnswer nearest_on_target(const TreeFacts& tree, const Point& query,
                                const NearestLimits& limits, PageReader pages, TreeWork& work,
                                Vicinity* vicinity) {
  const auto answer_of = [&](Descent& descent) {
    return conclude(tree, query, limits, descent.best(), descent.wide(), descent.pruned(),
                    descent.unread());
  };
  if (vicinity && vicinity->holds(query)) {
    Descent descent(tree, query, limits, pages, work);
    descent.run_from(vicinity->front());
    NearestAnswer answer = answer_of(descent);
    if (answer.status == Status::kExact) {
      vicinity->note(query, answer.distance);
      return answer;
    }
    // Lost pages, or nothing so near as asked: told from the root, as ever.
    vicinity->forget();
  }
  Descent descent(tree, query, limits, pages, work);
  descent.run_from_root();
  NearestAnswer answer = answer_of(descent);
  if (vicinity && answer.status == Status::kExact) {
    renew(*vicinity, tree, query, answer.distance, pages, work);
    vicinity->note(query, answer.distance);
  }
  return answer;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {

HWY_EXPORT(nearest_on_target);

NearestAnswer nearest(const TreeFacts& tree, const Point& query, const NearestLimits& limits,
                      PageReader pages, TreeWork& work, Vicinity* vicinity) noexcept {
  assert(query.cwiseAbs().maxCoeff() <= kFarthestQuery);
  // Limited work and errors depend on the way that is taken.
  const bool unlimited =
      limits.max_error == 0 && limits.max_nodes == std::numeric_limits<std::uint32_t>::max();
  return HWY_DYNAMIC_DISPATCH(nearest_on_target)(tree, query, limits, pages, work,
                                                 unlimited ? vicinity : nullptr);
}

}  // namespace planetree::octree
#endif
