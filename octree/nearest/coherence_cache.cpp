#include "octree/nearest/coherence_cache.h"

#include <algorithm>
#include <array>
#include <bit>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"
#include "octree/page/frame.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/link_resolver.h"
#include "octree/traversal/overlap.h"
#include "octree/traversal/tree_view.h"

namespace planetree::octree {
namespace {

// Finds a limited number of records by their links: a forged tree could lead to the same record
// again and again.
class LimitedFinder {
 public:
  LimitedFinder(const TreeInfo& tree, WorkLimit& limit, const PageReader& pages,
                TraversalStats& work)
      : records_(tree, pages), work_(work), limit_(limit), left_(tree.record_count) {}

  // Returns null if the record's page is missing or no work is left.
  const std::byte* find(std::uint32_t link) {
    const unsigned units = LinkFormat::is_leaf(link) ? WorkUnits::kBallBlock : 1;
    const std::byte* record =
        left_ > 0 && limit_.try_take(units) ? records_.find(link, work_) : nullptr;
    if (!record) {
      left_ = 0;  // after a missing page nothing more is searched
      return nullptr;
    }
    --left_;
    ++(LinkFormat::is_leaf(link) ? work_.blocks : work_.nodes);
    return record;
  }

 private:
  LinkResolver records_;
  TraversalStats& work_;
  WorkLimit& limit_;
  std::uint64_t left_;
};

// A ball that children of nodes and triangles of blocks are tested against.
class Ball {
 public:
  Ball(const TreeInfo& tree, const Point& centre, double radius)
      : centre_(centre),
        radius_(radius),
        query_(FloatQuery::from(centre, tree)),
        threshold_(prune_threshold(query_, radius)) {}

  // Adds the children that reach into the ball.
  void add_children(const Node& node, NearbySubtrees& found) const {
    add_children_within(node, query_, threshold_, found);
  }
  // Returns a bit for each triangle that reaches into the ball; see triangles_within().
  unsigned reached_by(const BlockView& block, double (&nearest)[kMaxBlockTriangles]) const {
    return triangles_within(block, centre_, query_, radius_, nearest);
  }

 private:
  const Point& centre_;
  const double radius_;
  const FloatQuery query_;
  const float threshold_;
};

// Finds the subtrees that reach into a ball. It goes down from the root, level by level, as long
// as the list has capacity.
class SubtreeSearch {
 public:
  SubtreeSearch(const Ball& ball, LimitedFinder& records, NearbySubtrees& found)
      : ball_(ball), records_(records), found_(found) {}

  // Returns false if there is nothing to keep.
  bool run(std::uint32_t root_link) {
    found_.clear();
    const Node* root = node(root_link);
    if (!root) return false;
    ball_.add_children(*root, found_);
    while (open_level()) {
    }
    return found_.size() > 0;
  }

 private:
  // Replaces nodes in the list by those of their children that reach into the ball. Returns false
  // if it replaced none.
  bool open_level() {
    bool opened = false;
    for (std::size_t i = found_.size(); i-- > 0 && found_.has_capacity();) {
      const Node* opening = node(found_.link(i));
      if (!opening) continue;
      found_.remove(i);
      ball_.add_children(*opening, found_);
      opened = true;
    }
    return opened;
  }

  // Returns null for a block, for a missing page, and if no work is left.
  const Node* node(std::uint32_t link) {
    return LinkFormat::is_leaf(link) ? nullptr : reinterpret_cast<const Node*>(records_.find(link));
  }

  const Ball& ball_;
  LimitedFinder& records_;
  NearbySubtrees& found_;
};

// Collects the triangles of some blocks that reach into a ball.
class TriangleSearch {
 public:
  TriangleSearch(const TreeInfo& tree, const Ball& ball) : tree_(tree), ball_(ball) {}

  // The triangles of more blocks rarely fit into NearbyTriangles.
  static constexpr std::size_t kMaxBlocks = 28;

  // Returns false if the triangles are too many or a page is missing.
  bool run(const NearbySubtrees& blocks, LimitedFinder& records) {
    if (blocks.size() > kMaxBlocks) return false;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const std::byte* record = records.find(blocks.link(i));
      if (!record) return false;
      if (!add(BlockView(record, tree_.shape))) return false;
    }
    return true;
  }

  std::span<const NearbyTriangle> found() const { return {found_.data(), count_}; }

 private:
  bool add(const BlockView& block) {
    double nearest[kMaxBlockTriangles];
    unsigned near = ball_.reached_by(block, nearest);
    if (count_ + static_cast<unsigned>(std::popcount(near)) > found_.size()) return false;
    for (; near != 0; near &= near - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(near));
      found_[count_++] = {block.triangle(i), block.id(i), nearest[i],
                          block.header().is_height_field()};
    }
    return true;
  }

  const TreeInfo& tree_;
  const Ball& ball_;
  std::size_t count_ = 0;
  std::array<NearbyTriangle, NearbyTriangles::kMax> found_;
};

}  // namespace

void CoherenceCache::renew(const TreeInfo& tree, const Point& query, double distance,
                           WorkLimit& limit, const PageReader& pages,
                           TraversalStats& work) noexcept {
  const double diagonal = (tree.core_upper - tree.core_lower).norm();
  const double radius = wanted_radius(query, distance, diagonal);
  if (!(radius > 0)) return;
  centre_ = query;
  radius_ = radius;
  triangles_.clear();
  const Ball ball(tree, centre_, radius_);
  LimitedFinder records(tree, limit, pages, work);
  if (!SubtreeSearch(ball, records, subtrees_).run(tree.root_link)) return forget();
  if (!subtrees_.are_blocks()) return;
  TriangleSearch search(tree, ball);
  if (search.run(subtrees_, records)) triangles_.fill(search.found(), centre_, distance, radius_);
}

}  // namespace planetree::octree
