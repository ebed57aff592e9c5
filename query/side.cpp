#include "query/side.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "octree/crossings.h"
#include "octree/nearest.h"
#include "octree/strict_math.h"
#include "octree/winding_number.h"

namespace planetree::query {
namespace {

using octree::Point;

/// The ways straight out of a box along the axes, the shortest first.
class WaysOut {
 public:
  WaysOut(const octree::TreeFacts& tree, const Point& from) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      add(from, axis, tree.box_lower[axis], -1);
      add(from, axis, tree.box_upper[axis], 1);
    }
  }

  struct Way {
    double length = 0;
    Point end = Point::Zero();  ///< strictly outside
  };
  const std::array<Way, 6>& all() const { return ways_; }

 private:
  void add(const Point& from, Eigen::Index axis, double side, double direction) {
    Way way{std::fabs(side - from[axis]), from};
    // A side far from the origin may absorb the step of 1.
    const double infinity = std::numeric_limits<double>::infinity();
    const double beyond = std::nextafter(side, direction * infinity);
    way.end[axis] = direction < 0 ? std::min(side - 1, beyond) : std::max(side + 1, beyond);
    // Behind those that are as short.
    std::size_t at = count_++;
    for (; at > 0 && way.length < ways_[at - 1].length; --at) ways_[at] = ways_[at - 1];
    ways_[at] = way;
  }

  std::size_t count_ = 0;
  std::array<Way, 6> ways_;
};

bool outside_box(const octree::TreeFacts& tree, const Point& point) {
  return (point.array() < tree.box_lower.array()).any() ||
         (point.array() > tree.box_upper.array()).any();
}

Standing by_crossings(const ModelState& model, const Point& point, std::uint64_t max_nodes,
                      octree::PageReader pages, octree::TreeWork& work) {
  if (outside_box(model.tree(), point)) return {Side::kOutside};
  // Usually the first way tells; another may do without a page that is lost.
  const WaysOut ways(model.tree(), point);
  const std::uint64_t before = work.nodes + work.blocks;
  for (const WaysOut::Way& way : ways.all()) {
    const std::uint64_t spent = work.nodes + work.blocks - before;
    if (spent >= max_nodes) break;
    const octree::Crossings crossings =
        octree::count_crossings(model.tree(), {point, way.end}, max_nodes - spent, pages, work);
    if (!crossings.complete) continue;
    const Side off_surface = crossings.difference != 0 ? Side::kInside : Side::kOutside;
    return {crossings.on_surface ? Side::kOnSurface : off_surface, Status::kExact,
            crossings.difference};
  }
  return {Side::kUnknown, Status::kDegraded};
}

/// The nearest whole number, however large.
std::int64_t rounded(double value) {
  constexpr double kMost = 0x1p62;
  return static_cast<std::int64_t>(std::clamp(value + (value < 0 ? -0.5 : 0.5), -kMost, kMost));
}

Standing by_winding_number(const octree::TreeFacts& tree, const Point& point,
                           std::uint64_t max_nodes, octree::PageReader pages,
                           octree::TreeWork& work) {
  // From so far away all triangles together are less than a point.
  if (!(point.cwiseAbs().maxCoeff() <= octree::kFarthestQuery)) return {Side::kOutside};
  const octree::WindingNumber w = octree::winding_number(tree, point, max_nodes, pages, work);
  if (w.on_surface) {
    const bool told = std::fabs(w.value) > w.error;
    return {Side::kOnSurface, Status::kExact, told ? (w.value < 0 ? -1 : 1) : 0, false};
  }
  if (w.above_half()) return {Side::kInside, Status::kExact, rounded(w.value)};
  if (w.below_half()) return {Side::kOutside, Status::kExact};
  return {Side::kUnknown, w.complete ? Status::kExact : Status::kDegraded};
}

}  // namespace

Standing find_side(const ModelState& model, const Point& point, std::uint64_t max_nodes,
                   octree::PageReader pages, octree::TreeWork& work) noexcept {
  return model.info().watertight() ? by_crossings(model, point, max_nodes, pages, work)
                                   : by_winding_number(model.tree(), point, max_nodes, pages, work);
}

}  // namespace planetree::query
