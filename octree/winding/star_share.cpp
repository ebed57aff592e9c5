#include "octree/winding/star_share.h"

#include <algorithm>
#include <array>

#include "octree/geometry/angles.h"
#include "octree/geometry/certain_sum.h"
#include "octree/geometry/error_bounds.h"
#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/work_limit.h"
#include "octree/traversal/tree_walk.h"

namespace planetree::octree {
namespace {

/// Directions to b. If b is in the plane of a triangle, the next is tried.
constexpr std::array<std::array<double, 3>, 6> kDirections{{{0.8125, 0.4375, 0.3671875},
                                                            {-0.3359375, 0.875, 0.296875},
                                                            {0.2890625, -0.3828125, 0.8515625},
                                                            {-0.71875, -0.5390625, -0.421875},
                                                            {0.4921875, 0.6640625, -0.5546875},
                                                            {-0.1796875, 0.6171875, -0.7578125}}};
/// Minimum distance of b, as a share of the point's coordinates.
constexpr double kMinReach = 0x1p-10;

/// The sum for one choice of b.
class StarSum {
 public:
  StarSum(const Point& point, const std::array<double, 3>& direction, WorkLimit& limit)
      : point_(point),
        apex_(point + std::max(1.0, kMinReach * point.cwiseAbs().maxCoeff()) *
                          Point(direction[0], direction[1], direction[2])),
        limit_(limit) {}

  /// Adds a triangle if the point is on it.
  void add(const Triangle& triangle) {
    if (!limit_.take(WorkUnits::kExactCrossing)) return;
    if (!lies_on(point_, triangle, &limit_)) return;
    const int side = perturbed_side(triangle, point_, &limit_);
    const int apex_side = orientation(triangle[0], triangle[1], triangle[2], apex_, &limit_);
    // A triangle without area spans no tetrahedron.
    if (side != 0 && apex_side == 0) is_good_ = false;
    bool is_inside = side != 0 && side == apex_side;
    for (unsigned corner = 0; corner < 3 && is_good_; ++corner)
      is_inside = add_edge(triangle, corner) && is_inside;
    if (is_inside) sum_.add(-apex_side);
  }

  bool is_good() const { return is_good_; }
  StarShare share() const { return {sum_.value(), error_ + sum_.error()}; }

 private:
  // Returns whether the moved point is on the inner side of the tetrahedron's side along an edge.
  bool add_edge(const Triangle& triangle, unsigned corner) {
    const Point &from = triangle[corner], &to = triangle[(corner + 1) % 3],
                &opposite = triangle[(corner + 2) % 3];
    if (from == to) return true;
    const Triangle side{from, to, apex_};
    if (!limit_.take(2 * WorkUnits::kExactCrossing)) return false;
    if (lies_on(point_, {from, to, to}, &limit_)) {
      const int inner = orientation(from, to, apex_, opposite, &limit_);
      return inner == 0 || perturbed_side(side, point_, &limit_) == inner;
    }
    const WindingShare share = winding_share(point_, side, &limit_);
    is_good_ = is_good_ && !share.on_surface;
    sum_.add(share.value);
    error_ += share.error;
    return true;
  }

  const Point& point_;
  const Point apex_;
  WorkLimit& limit_;
  CertainSum sum_;
  double error_ = 0;
  bool is_good_ = true;
};

// Calls call(triangle) for each triangle whose box may have the point.
template <class Call>
bool for_each_near(const TreeInfo& tree, const Point& point, WorkLimit& limit,
                   const PageReader& pages, TraversalStats& work, const Call& call) {
  return BoxWalk(tree, point, point, pages, work)
      .run(limit.left(), [&](const BlockView& block, std::uint32_t) {
        for (unsigned i = 0; i < block.triangle_count(); ++i) {
          const Triangle triangle = block.triangle(i);
          if ((least_corner(triangle).array() <= point.array()).all() &&
              (greatest_corner(triangle).array() >= point.array()).all())
            call(triangle);
        }
      });
}

}  // namespace

StarShare star_share(const TreeInfo& tree, const Point& point, std::uint64_t max_work,
                     const PageReader& pages, TraversalStats& work) noexcept {
  WorkLimit limit(work.units, max_work);
  for (const std::array<double, 3>& direction : kDirections) {
    StarSum sum(point, direction, limit);
    const auto add = [&sum](const Triangle& triangle) { sum.add(triangle); };
    bool complete = for_each_near(tree, point, limit, pages, work, add);
    if (complete && tree.caps) complete = for_each_near(*tree.caps, point, limit, pages, work, add);
    if (!complete || limit.exceeded()) break;
    if (sum.is_good()) return sum.share();
  }
  return {0, 0, false};
}

}  // namespace planetree::octree
