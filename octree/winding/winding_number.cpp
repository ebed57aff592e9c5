#include "octree/winding/winding_number.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "octree/geometry/angles.h"
#include "octree/geometry/certain_sum.h"
#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"
#include "octree/page/frame.h"
#include "octree/traversal/link_resolver.h"
#include "octree/traversal/tree_view.h"
#include "octree/winding/block_share.h"
#include "octree/winding/multipole.h"

namespace planetree::octree {
namespace {

/// A child that stands in the sum by its moments.
struct Proxy {
  Multipoles::Share share;
  std::uint32_t link;
  std::uint32_t order;  ///< greater for children added later

  bool known() const { return share.error <= Multipoles::kMaxShareError; }
  /// The greatest of a heap is the most uncertain, of equals the last added. So unknown children
  /// are opened depth first.
  friend bool operator<(const Proxy& a, const Proxy& b) {
    return a.share.error < b.share.error || (a.share.error == b.share.error && a.order < b.order);
  }
};

/// Children still to be opened. As long as the heap has capacity, they are in it, the most
/// uncertain on top. Once it is full, the children of the next child opened go to a stack. The
/// stack is emptied first, its last entry first, and takes all children opened meanwhile.
class OpenList {
 public:
  bool empty() const { return size_ == 0 && deep_size_ == 0; }
  bool has_capacity() const { return size_ + kFanOut <= heap_.size(); }
  bool deep_has_capacity() const { return deep_size_ + kFanOut <= deep_.size(); }
  bool is_deep() const { return deep_size_ > 0; }

  void push(const Proxy& proxy) {
    heap_[size_++] = proxy;
    std::push_heap(heap_.begin(), heap_.begin() + size_);
  }
  void push_deep(const Proxy& proxy) { deep_[deep_size_++] = proxy; }
  Proxy pop() {
    if (deep_size_ > 0) return deep_[--deep_size_];
    std::pop_heap(heap_.begin(), heap_.begin() + size_);
    return heap_[--size_];
  }

 private:
  std::size_t size_ = 0, deep_size_ = 0;
  std::array<Proxy, 1024> heap_;
  std::array<Proxy, (kFanOut - 1) * kMaxHeight + 2 * kFanOut> deep_;
};

class WindingSum {
 public:
  WindingSum(const TreeInfo& tree, const Point& point, std::uint64_t max_work,
             const PageReader& pages, TraversalStats& work, const WindingBase& base,
             WindingGoal goal)
      : tree_(tree),
        point_(point),
        goal_(goal),
        work_(work),
        limit_(work.units, max_work),
        multipoles_(point, tree),
        records_(tree, pages) {
    value_.add(base.value);
    error_.add(base.error);
  }

  WindingNumber run() {
    // At most the number of records: in a forged tree links could lead in circles.
    std::uint64_t left = tree_.record_count;
    add_proxy({{0, Multipoles::kUnknown}, tree_.root_link, 0});
    open_list_.push({{0, Multipoles::kUnknown}, tree_.root_link, 0});
    while (!open_list_.empty() && !decided()) {
      const Proxy proxy = open_list_.pop();
      // After the loss of an unknown child, all that can still be found is that the point is on the
      // surface. A child of known share is too far away for that.
      if (lost_unknown_ && proxy.known()) continue;
      if (left-- == 0 || !limit_.take()) {
        complete_ = false;
        break;
      }
      open(proxy);
    }
    complete_ = complete_ && !limit_.exceeded();
    WindingNumber result = sum();
    // Records that were lost may leave the error below its limit without telling the sign that all
    // records tell.
    result.complete =
        complete_ || (goal_ == WindingGoal::kSign ? result.sign_is_certain() : decided());
    return result;
  }

 private:
  WindingNumber sum() const {
    WindingNumber result;
    result.value = value_.value();
    result.error =
        unknown_ > 0 ? Multipoles::kUnknown
                     : (error_.value() + error_.error() + value_.error()) * kWindingErrorInflation;
    result.on_surface = on_surface_;
    return result;
  }

  bool decided() const {
    if (unknown_ > 0) return false;
    const WindingNumber so_far = sum();
    if (goal_ == WindingGoal::kHalf) return so_far.above_half() || so_far.below_half();
    return so_far.sign_is_certain() || so_far.error < kMaxSurfaceWindingError;
  }

  void add_proxy(const Proxy& proxy) {
    if (proxy.known()) {
      value_.add(proxy.share.value);
      error_.add(proxy.share.error);
    } else {
      ++unknown_;
    }
  }
  void remove_proxy(const Proxy& proxy) {
    if (proxy.known()) {
      value_.add(-proxy.share.value);
      error_.add(-proxy.share.error);
    } else {
      --unknown_;
    }
  }

  // Replaces a child by its own children or triangles. A record whose page is missing stays in the
  // sum by its moments.
  void open(const Proxy& proxy) {
    const bool deep = open_list_.is_deep() || !open_list_.has_capacity();
    const std::byte* record = records_.find(proxy.link, work_);
    const bool leaf = LinkFormat::is_leaf(proxy.link);
    // Only a forged tree is deeper than kMaxHeight, for which the stack has capacity.
    if (!record || (!leaf && deep && !open_list_.deep_has_capacity())) {
      complete_ = false;
      lost_unknown_ = lost_unknown_ || !proxy.known();
      return;
    }
    if (leaf) return open_block(BlockView(record, tree_.shape), proxy);
    if (!limit_.take(WorkUnits::kMoments)) return;
    remove_proxy(proxy);
    open_node(*reinterpret_cast<const Node*>(record), deep);
  }

  void open_node(const Node& node, bool deep) {
    ++work_.nodes;
    std::array<Multipoles::Share, kFanOut> shares;
    multipoles_.shares(node, shares);
    for (unsigned child = 0; child < node.child_count; ++child) {
      const Proxy proxy{shares[child], node.link[child], ++order_};
      add_proxy(proxy);
      if (deep)
        open_list_.push_deep(proxy);
      else
        open_list_.push(proxy);
    }
  }

  void open_block(const BlockView& block, const Proxy& proxy) {
    if (!limit_.take(block.triangle_count() / WorkUnits::kBlockAngles)) return;
    ++work_.blocks;
    work_.triangles += block.triangle_count();
    const BlockShare sum = block_share(point_, block);
    const auto unsure = static_cast<unsigned>(std::popcount(sum.unsure));
    if (!limit_.take((unsure + WorkUnits::kSolidAngles - 1) / WorkUnits::kSolidAngles)) return;
    remove_proxy(proxy);
    value_.add(sum.value);
    error_.add(sum.error);
    for (unsigned left = sum.unsure; left != 0; left &= left - 1) {
      const auto i = static_cast<unsigned>(std::countr_zero(left));
      const WindingShare share = winding_share(point_, block.triangle(i), &limit_);
      value_.add(share.value);
      error_.add(share.error);
      on_surface_ = on_surface_ || share.on_surface;
    }
  }

  const TreeInfo& tree_;
  const Point& point_;
  const WindingGoal goal_;
  TraversalStats& work_;
  WorkLimit limit_;
  const Multipoles multipoles_;
  LinkResolver records_;
  OpenList open_list_;
  CertainSum value_, error_;
  std::uint64_t unknown_ = 0;  ///< number of proxies of unknown share
  std::uint32_t order_ = 0;
  bool lost_unknown_ = false;
  bool on_surface_ = false;
  bool complete_ = true;
};

}  // namespace

WindingNumber winding_number(const TreeInfo& tree, const Point& point, std::uint64_t max_work,
                             const PageReader& pages, TraversalStats& work, const WindingBase& base,
                             WindingGoal goal) noexcept {
  return WindingSum(tree, point, max_work, pages, work, base, goal).run();
}

}  // namespace planetree::octree
