#include "octree/mask/cap_grid.h"

#include <bit>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/tree_limits.h"
#include "octree/page/moments.h"
#include "octree/traversal/bounds.h"

namespace planetree::octree {
namespace {

/// The greatest share in a clear cell. What it lacks to one half covers the rounding of bounds.
constexpr double kMaxClearShare = 0.49;
/// Children of a smaller share are not opened.
constexpr double kSmallShare = kMaxClearShare / 64;
/// Covers the rounding of coordinates relative to the centre, and of cells.
constexpr double kClearSlack = 0x1p-24;
constexpr double kOverFourPi = 0x1.45f306dc9c883p-4;
/// Maximum number of records to visit for all cells, and of lookups of pages that are not resident.
/// They bound the time to open a model.
constexpr std::uint64_t kMinVisits = 1 << 8, kMaxVisits = std::uint64_t{1} << 17;
constexpr std::uint64_t kVisitsPerRecord = 32;
constexpr std::uint64_t kMaxBrought = 1 << 12;

}  // namespace

/// Bounds the share of the caps over cells, the largest cells first.
class CapGrid::Filler {
 public:
  Filler(CapGrid& grid, const TreeInfo& caps, std::uint64_t visits, const PageReader& pages)
      : grid_(grid), caps_(caps), pages_(pages), records_(caps, pages), left_(visits) {}

  void run() {
    set_all(0, 0, false);
    for (unsigned level = 1; level <= kLevel && left_ > 0; ++level)
      for (std::uint64_t index = 0; index < std::uint64_t{1} << 3 * level && left_ > 0; ++index)
        if (!is_set(level, index) && is_clear(level, index)) set_all(level, index, true);
  }

 private:
  // Cells within a cell are side by side in Morton order.
  static std::uint64_t first_of(unsigned level, std::uint64_t index) {
    return index << 3 * (kLevel - level);
  }
  bool is_set(unsigned level, std::uint64_t index) const {
    const std::uint64_t first = first_of(level, index);
    return (grid_.clear_[first / 64] >> first % 64 & 1) != 0;
  }
  void set_all(unsigned level, std::uint64_t index, bool clear) {
    const std::uint64_t first = first_of(level, index), count = first_of(level, 1);
    if (count < 64) {
      const std::uint64_t bits = ((std::uint64_t{1} << count) - 1) << first % 64;
      std::uint64_t& word = grid_.clear_[first / 64];
      word = clear ? word | bits : word & ~bits;
    } else {
      std::fill_n(grid_.clear_ + first / 64, count / 64, clear ? ~std::uint64_t{0} : 0);
    }
  }

  bool is_clear(unsigned level, std::uint64_t index) {
    const double side = kSide / (1U << level);
    const std::array<std::uint32_t, 3> at{gather_bits(index), gather_bits(index >> 1),
                                          gather_bits(index >> 2)};
    for (unsigned axis = 0; axis < 3; ++axis) {
      lower_[axis] = grid_.lower_[axis] + side * at[axis] - caps_.centre[axis] - kClearSlack;
      upper_[axis] = lower_[axis] + side + 2 * kClearSlack;
    }
    share_ = 0;
    size_ = 0;
    push(caps_.root_link);
    while (size_ > 0 && share_ < kMaxClearShare)
      if (!open(links_[--size_])) return false;
    return share_ < kMaxClearShare;
  }

  void push(std::uint32_t link) { links_[size_++] = link; }

  // Replaces a child by its own children or caps. Returns false if the cell cannot be clear.
  bool open(std::uint32_t link) {
    if (left_ == 0) return false;
    --left_;
    if (is_brought(link) && ++brought_ > kMaxBrought) left_ = 0;
    const std::byte* record = records_.find(link, work_);
    if (!record) return false;
    if (LinkFormat::is_leaf(link)) return add_block(BlockView(record, caps_.shape));
    const Node& node = *reinterpret_cast<const Node*>(record);
    if (size_ + kFanOut > links_.size()) return false;
    double largest = 0;
    for (unsigned child = 0; child < node.child_count; ++child) {
      const Moments moments = NodeMoments::of(node).child(child);
      const FloatBox box = child_box(node, child);
      double gap2 = 0;
      for (unsigned axis = 0; axis < 3; ++axis)
        gap2 += gap_of(axis, static_cast<double>(box.lower[axis]),
                       static_cast<double>(box.upper[axis]));
      const double share = kOverFourPi * Moments::wide(moments.area) / gap2;
      if (gap2 > 0 && moments.are_known() && share < kSmallShare) {
        share_ += share;
        continue;
      }
      push(node.link[child]);
      // The child of the largest share is opened first, since it may decide.
      if (share < largest) std::swap(links_[size_ - 1], links_[size_ - 2]);
      largest = std::max(largest, share);
    }
    return true;
  }

  // Whether looking a record up has to fetch its page.
  bool is_brought(std::uint32_t link) const {
    return !records_.is_in_current_page(link) && pages_.peek &&
           !pages_.peek(pages_.context, LinkFormat(caps_.page_bytes).page(link));
  }

  bool add_block(const BlockView& block) {
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      const Triangle cap = block.triangle(i);
      const Point least = least_corner(cap) - caps_.centre;
      const Point greatest = greatest_corner(cap) - caps_.centre;
      double gap2 = 0;
      for (unsigned axis = 0; axis < 3; ++axis) gap2 += gap_of(axis, least[axis], greatest[axis]);
      if (!(gap2 > 0)) return false;
      share_ += kOverFourPi * area_of(cap) / gap2;
    }
    return true;
  }

  // Square of the gap between the cell and a box along an axis.
  double gap_of(unsigned axis, double lower, double upper) const {
    const double gap = std::max({0.0, lower - upper_[axis], lower_[axis] - upper});
    return gap * gap;
  }

  CapGrid& grid_;
  const TreeInfo& caps_;
  const PageReader& pages_;
  LinkResolver records_;
  TraversalStats work_;
  std::uint64_t brought_ = 0;
  std::uint64_t left_;                                   // visits
  Point lower_ = Point::Zero(), upper_ = Point::Zero();  // of the cell, relative to the centre
  double share_ = 0;
  std::size_t size_ = 0;
  std::array<std::uint32_t, (kFanOut - 1) * kMaxHeight + 2 * kFanOut> links_;
};

void CapGrid::fill(const TreeInfo& caps, std::uint64_t records, const Point& lower,
                   const PageReader& pages, std::span<std::byte> memory) noexcept {
  lower_ = lower - Point::Constant(kMargin);
  clear_ = reinterpret_cast<std::uint64_t*>(memory.data());
  const std::uint64_t few = std::min(records, kMaxVisits);
  const std::uint64_t visits = std::clamp(kVisitsPerRecord * few, kMinVisits, kMaxVisits);
  Filler(*this, caps, visits, pages).run();
}

bool CapGrid::all_are_clear(const std::array<std::uint32_t, 3>& from,
                            const std::array<std::uint32_t, 3>& to) const {
  for (std::uint32_t z = from[2]; z <= to[2]; ++z)
    for (std::uint32_t y = from[1]; y <= to[1]; ++y)
      for (std::uint32_t x = from[0]; x <= to[0]; ++x)
        if (!is_clear_at({x, y, z})) return false;
  return true;
}

}  // namespace planetree::octree
