#include "octree/mask/cap_grid.h"

#include <bit>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/tree_limits.h"
#include "octree/mask/cap_rim.h"
#include "octree/page/moments.h"
#include "octree/traversal/bounds.h"
#include "octree/traversal/link_resolver.h"
#include "octree/winding/winding_number.h"

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
/// The same for caps and edges of a rim that are looked at. A unit of work counts for
/// kLooksPerUnit.
constexpr std::uint64_t kMinLooks = 1 << 12, kMaxLooks = std::uint64_t{1} << 24;
constexpr std::uint64_t kMaxLooksPerRecord = 1 << 11, kLooksPerUnit = 32;
/// Minimum number of records of a surface whose rim is read.
constexpr std::uint64_t kMinRecordsOfRim = 128;

}  // namespace

/// Bounds the share of caps over cells by their areas, the largest cells first. A cap of area
/// a at a distance of at least d has a share of at most a / (4 pi d^2).
class CapGrid::AreaFiller {
 public:
  AreaFiller(CapGrid& grid, const TreeInfo& caps, std::uint64_t visits, const PageReader& pages)
      : grid_(grid), caps_(caps), pages_(pages), records_(caps, pages), left_(visits) {}

  void run() {
    for (unsigned level = 1; level <= kLevel && left_ > 0; ++level)
      for (std::uint64_t index = 0; index < std::uint64_t{1} << 3 * level && left_ > 0; ++index)
        if (!grid_.is_set(level, index) && is_clear(level, index)) grid_.set_clear(level, index);
  }

 private:
  bool is_clear(unsigned level, std::uint64_t index) {
    grid_.find_box(level, index, lower_, upper_);
    lower_ -= caps_.centre;
    upper_ -= caps_.centre;
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
           !pages_.peek(pages_.context, records_.page_of(link));
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

/// Bounds the share of few caps over the cells that are left: by that at the cell's centre, and by
/// how much the rim lets it vary.
class CapGrid::RimFiller {
 public:
  RimFiller(CapGrid& grid, const TreeInfo& caps, const CapRim& rim, std::uint64_t looks,
            const PageReader& pages)
      : grid_(grid), caps_(caps), rim_(rim), pages_(pages), left_(looks) {}

  void run() {
    for (unsigned cap = 0; cap < rim_.caps(); ++cap)
      meeting_[0][cap] = static_cast<std::uint16_t>(cap);
    // The largest cells first, for the looks may not suffice for the smallest.
    for (unsigned level = 1; level <= kLevel && left_ > 0; ++level)
      refine(0, 0, level, rim_.caps());
  }

 private:
  // Tests the cells of the level `last` within a cell.
  //
  // caps  number of caps that may meet the cell around this one
  void refine(unsigned level, std::uint64_t index, unsigned last, std::size_t caps) {
    if (left_ == 0 || grid_.is_set(level, index)) return;
    Point lower, upper;
    grid_.find_box(level, index, lower, upper);
    const auto& around = meeting_[level];
    auto& here = meeting_[level + 1];
    std::size_t count = 0;
    for (std::size_t i = 0; i < caps; ++i)
      if (rim_.may_meet(around[i], lower, upper)) here[count++] = around[i];
    left_ -= std::min<std::uint64_t>(left_, caps + 1);
    if (level < last) {
      for (std::uint64_t octant = 0; octant < kFanOut; ++octant)
        refine(level + 1, kFanOut * index + octant, last, count);
    } else if (count == 0 && is_clear(lower, upper)) {
      grid_.set_clear(level, index);
    }
  }

  bool is_clear(const Point& lower, const Point& upper) {
    if (left_ < rim_.edges()) return false;
    left_ -= rim_.edges();
    const double most = kMaxClearShare - rim_.variation(lower, upper);
    if (!(most > 0)) return false;
    const Point centre = (lower + upper) * 0.5;
    return is_below(centre, most, 1) && is_below(centre, most, -1);
  }

  // Whether the share at a point, times a sign, is below a limit. Moved by the distance of the
  // limit from one half, the share is decided soon on either side of it.
  bool is_below(const Point& point, double most, double sign) {
    const std::uint64_t before = work_.units;
    const WindingNumber share = winding_number(caps_, point, left_ / kLooksPerUnit, pages_, work_,
                                               {sign * (0.5 - most), 0x1p-40});
    left_ -= std::min(left_, (work_.units - before) * kLooksPerUnit);
    return share.complete && !share.on_surface && sign * share.value + share.error < 0.5;
  }

  CapGrid& grid_;
  const TreeInfo& caps_;
  const CapRim& rim_;
  const PageReader& pages_;
  std::uint64_t left_;  // looks
  TraversalStats work_;
  // Caps that may meet the cell of the level above.
  std::array<std::array<std::uint16_t, CapRim::kMaxCaps>, kLevel + 2> meeting_;
};

void CapGrid::fill(const TreeInfo& caps, const TreeInfo& surface, const PageReader& pages,
                   std::span<std::byte> memory) noexcept {
  const double edge = (surface.core_upper - surface.core_lower).maxCoeff();
  side_ = kSidePerCore * std::clamp(edge, 1.0, 2.0);
  cells_per_unit_ = kWidth / side_;
  lower_ = (surface.core_lower + surface.core_upper - Point::Constant(side_)) * 0.5;
  clear_ = reinterpret_cast<std::uint64_t*>(memory.data());
  std::fill_n(clear_, kBytes / sizeof *clear_, 0);
  const std::uint64_t records = std::min(surface.record_count, kMaxVisits);
  const std::uint64_t visits = std::clamp(kVisitsPerRecord * records, kMinVisits, kMaxVisits);
  AreaFiller(*this, caps, visits, pages).run();
  // A small model has few caps to sum, and should open in little time.
  if (records < kMinRecordsOfRim) return;
  CapRim rim;
  rim.read(caps, pages);
  if (!rim.is_known()) return;
  const std::uint64_t looks =
      std::clamp(std::min(records, kMaxLooksPerRecord) * records, kMinLooks, kMaxLooks);
  RimFiller(*this, caps, rim, looks, pages).run();
}

void CapGrid::find_box(unsigned level, std::uint64_t index, Point& lower, Point& upper) const {
  const double side = side_ / (1U << level);
  const std::array<std::uint32_t, 3> at{gather_bits(index), gather_bits(index >> 1),
                                        gather_bits(index >> 2)};
  for (unsigned axis = 0; axis < 3; ++axis) {
    lower[axis] = lower_[axis] + side * at[axis] - kClearSlack;
    upper[axis] = lower[axis] + side + 2 * kClearSlack;
  }
}

bool CapGrid::is_set(unsigned level, std::uint64_t index) const {
  const std::uint64_t first = first_of(level, index), count = first_of(level, 1);
  if (count < 64)
    return (~clear_[first / 64] >> first % 64 & ((std::uint64_t{1} << count) - 1)) == 0;
  return std::all_of(clear_ + first / 64, clear_ + (first + count) / 64,
                     [](std::uint64_t word) { return word == ~std::uint64_t{0}; });
}

void CapGrid::set_clear(unsigned level, std::uint64_t index) {
  const std::uint64_t first = first_of(level, index), count = first_of(level, 1);
  if (count < 64)
    clear_[first / 64] |= ((std::uint64_t{1} << count) - 1) << first % 64;
  else
    std::fill_n(clear_ + first / 64, count / 64, ~std::uint64_t{0});
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
