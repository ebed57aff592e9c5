#include "octree/vicinity.h"

#include <algorithm>
#include <array>
#include <bit>

#include "octree/block_view.h"
#include "octree/bounds.h"
#include "octree/child_tests.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

// Records by their links, up to so many: a forged tree could lead to one again and again.
class LimitedFinder {
 public:
  LimitedFinder(const TreeFacts& tree, std::uint64_t most, PageReader pages, TreeWork& work)
      : records_(tree, pages), work_(work), left_(std::min(most, tree.record_count)) {}

  // Null where it cannot be had, or no more may be visited.
  const std::byte* find(std::uint32_t link) {
    const std::byte* record = left_ > 0 ? records_.find(link, work_) : nullptr;
    if (!record) return nullptr;
    --left_;
    ++(LinkFormat::is_leaf(link) ? work_.blocks : work_.nodes);
    return record;
  }

 private:
  RecordFinder records_;
  TreeWork& work_;
  std::uint64_t left_;
};

// A ball as the children of nodes are held against it.
class Ball {
 public:
  Ball(const TreeFacts& tree, const Point& centre, double radius)
      : query_(FloatQuery::from(centre, tree.centre)),
        threshold_(prune_threshold(query_, radius)) {}

  // A bit for each child that reaches into it.
  unsigned reached_by(const Node& node) const { return children_within(node, query_, threshold_); }

 private:
  const FloatQuery query_;
  const float threshold_;
};

// The subtrees that reach into a ball: from the root down, the largest first, as long as
// there is room for its children.
class FrontSearch {
 public:
  FrontSearch(const Ball& ball, LimitedFinder& records, Node& front)
      : ball_(ball), records_(records), front_(front) {}

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
    const std::byte* record = records_.find(link);
    if (!record) return false;
    const Node& node = *reinterpret_cast<const Node*>(record);
    unsigned near = ball_.reached_by(node);
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

  const Ball& ball_;
  LimitedFinder& records_;
  Node& front_;
  float size_[kFanOut];
  unsigned closed_ = 0;
};

// The blocks below a front that reach into a ball.
class BlockSearch {
 public:
  BlockSearch(const Ball& ball, LimitedFinder& records, NearbyBlocks& found)
      : ball_(ball), records_(records), found_(found) {}

  // False where they are too many, or a page is lost.
  bool run(const Node& front) {
    found_.begin();
    if (!take_children(front)) return false;
    while (size_ > 0) {
      const std::byte* record = records_.find(links_[--size_]);
      if (!record) return false;
      if (!take_children(*reinterpret_cast<const Node*>(record))) return false;
    }
    found_.finish();
    return true;
  }

 private:
  bool take_children(const Node& node) {
    if (size_ + kFanOut > links_.size()) return false;
    for (unsigned near = ball_.reached_by(node); near != 0; near &= near - 1) {
      const auto child = static_cast<unsigned>(std::countr_zero(near));
      if (!LinkFormat::is_leaf(node.link[child]))
        links_[size_++] = node.link[child];
      else if (!found_.add(node, child))
        return false;
    }
    return true;
  }

  const Ball& ball_;
  LimitedFinder& records_;
  NearbyBlocks& found_;
  std::size_t size_ = 0;
  std::array<std::uint32_t, 4 * kFanOut> links_;
};

// The squared distance to a triangle's box.
double squared_to_box(const Triangle& corners, const Point& centre) {
  const Point lower = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
  const Point upper = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
  return (lower - centre).cwiseMax(centre - upper).cwiseMax(0.0).squaredNorm();
}

// The triangles of some blocks that reach into a ball.
class TriangleSearch {
 public:
  TriangleSearch(const TreeFacts& tree, const Point& centre, double radius)
      : tree_(tree), centre_(centre), radius2_(radius * radius * (1 + 0x1p-40)) {}

  // More blocks than these do not keep to so few triangles.
  static constexpr std::size_t kMostBlocks = 28;

  // False where they are too many, or a page is lost.
  bool run(const NearbyBlocks& blocks, LimitedFinder& records) {
    if (blocks.size() > kMostBlocks) return false;
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
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      const Triangle corners = block.triangle(i);
      const double squared = squared_to_box(corners, centre_);
      if (squared > radius2_) continue;
      if (count_ == found_.size()) return false;
      found_[count_++] = {corners, block.id(i), squared};
    }
    return true;
  }

  const TreeFacts& tree_;
  const Point& centre_;
  const double radius2_;
  std::size_t count_ = 0;
  std::array<NearbyTriangle, NearbyTriangles::kMost> found_;
};

}  // namespace

void Vicinity::renew(const TreeFacts& tree, const Point& query, double distance,
                     std::uint64_t max_nodes, PageReader pages, TreeWork& work) noexcept {
  const double diagonal = (tree.box_upper - tree.box_lower).norm();
  const double radius = wanted_radius(query, distance, diagonal);
  if (!(radius > 0)) return;
  centre_ = query;
  radius_ = radius;
  blocks_.begin();
  triangles_.clear();
  const Ball ball(tree, centre_, radius_);
  LimitedFinder records(tree, max_nodes, pages, work);
  if (!FrontSearch(ball, records, front_).run(tree.root_link)) {
    forget();
    return;
  }
  if (radius_ > crowded_radius_ * kLessCrowded) return;
  const bool few = BlockSearch(ball, records, blocks_).run(front_);
  crowded_radius_ = few ? std::numeric_limits<double>::infinity() : radius_;
  if (!few) return;
  TriangleSearch search(tree, centre_, radius_);
  if (search.run(blocks_, records)) triangles_.fill(search.found(), centre_, distance, radius_);
}

}  // namespace planetree::octree
