#include "octree/builder/tree/moment_sums.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Error of the area of a thin triangle, as a share of the product of two sides. A cross product
/// errs by 5 roundings of it, before it is halved.
constexpr double kThinAreaError = 0x1p-48;
/// Relative error of a sum over up to 2^32 triangles: 2^-21.
constexpr double kMomentInflation = 1 + 0x1p-20;
/// What cancels where a second moment is moved to another centre, as a share of the squared
/// diagonal times the area.
constexpr double kMomentMoveError = 0x1p-40;

SurfaceSums of_triangle(const Triangle& triangle, const Point& from) {
  const Point a = triangle[0] - from, b = triangle[1] - from, c = triangle[2] - from;
  const Point u = b - a, v = c - a;
  const Point vector = 0.5 * u.cross(v);
  SurfaceSums sums;
  sums.vector = vector;
  // The area of a thin triangle may be too small by cancellation, but not by more than this.
  sums.area = vector.norm() + kThinAreaError * u.norm() * v.norm();
  const Point sum = a + b + c;
  sums.first = sum / 3 * vector.transpose();
  sums.position = sums.area / 3 * sum;
  sums.second =
      sums.area / 12 * (a.squaredNorm() + b.squaredNorm() + c.squaredNorm() + sum.squaredNorm());
  return sums;
}

/// Number of units nearest to a value, limited to a magnitude that only rounding exceeds.
template <class Integer>
Integer steps(double value, double unit, int max_units) {
  const double scaled = value / unit;
  const double rounded = scaled < 0 ? scaled - 0.5 : scaled + 0.5;
  return static_cast<Integer>(std::clamp(rounded, -1.0 * max_units, 1.0 * max_units));
}

class MomentSummer {
 public:
  MomentSummer(const Triangles& mesh, const Point& centre, const std::vector<MortonKey>& keys,
               const WideTree& tree)
      : mesh_(mesh),
        centre_(centre),
        keys_(keys),
        tree_(tree),
        node_sums_(tree.nodes.size()),
        moments_(tree.nodes.size()) {}

  TreeMoments run(const FloatBox& box) {
    // Children come after their parents.
    for (auto at = static_cast<std::uint32_t>(tree_.nodes.size()); at-- > 0;) sum_node(at);
    if (!tree_.nodes.empty()) return {std::move(moments_), node_sums_[0]};
    const WideBlock& block = tree_.blocks[0];
    return {{}, sum_block(block.begin, block.end, centre_of(box))};
  }

 private:
  void sum_node(std::uint32_t at) {
    const WideNode& node = tree_.nodes[at];
    const Point middle = centre_of(node.box);
    moments_[at] = {};
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      SurfaceSums sums = child.block ? sum_block(child.begin, child.end, centre_of(child.box))
                                     : node_sums_[child.index];
      moments_[at].set(i, packed(sums, child.box));
      sums.move(centre_of(child.box) - middle);
      node_sums_[at].add(sums);
    }
  }

  SurfaceSums sum_block(std::uint32_t first, std::uint32_t last, const Point& from) const {
    std::array<std::uint32_t, kMaxBlockTriangles> positions;
    const auto end = std::transform(keys_.begin() + first, keys_.begin() + last, positions.begin(),
                                    [](MortonKey key) { return key.position; });
    // In the order in which they are stored: keys within a block are not sorted.
    std::sort(positions.begin(), end,
              [this](std::uint32_t a, std::uint32_t b) { return mesh_.index(a) < mesh_.index(b); });
    SurfaceSums sums;
    for (auto position = positions.begin(); position != end; ++position) {
      Triangle triangle = mesh_.corners(*position);
      for (Point& corner : triangle) corner -= centre_;
      sums.add(of_triangle(triangle, from));
    }
    return sums;
  }

  const Triangles& mesh_;
  const Point& centre_;
  const std::vector<MortonKey>& keys_;
  const WideTree& tree_;
  std::vector<SurfaceSums> node_sums_;  ///< by node, about the centre of its box
  std::vector<NodeMoments> moments_;
};

}  // namespace

void SurfaceSums::add(const SurfaceSums& other) {
  vector += other.vector;
  first += other.first;
  area += other.area;
  position += other.position;
  second += other.second;
}

void SurfaceSums::move(const Point& by) {
  first += by * vector.transpose();
  second += 2 * by.dot(position) + by.squaredNorm() * area;
  position += area * by;
}

Moments packed(const SurfaceSums& sums, const FloatBox& box) {
  // These shares are far more than rounding may have cost: moving the reference point cancels no
  // more than the square of the box's diagonal.
  const auto diagonal2 = static_cast<double>(box.diagonal_squared());
  const double area = sums.area * kMomentInflation;
  const double second =
      std::max(0.0, sums.second) * kMomentInflation + kMomentMoveError * diagonal2 * area;
  Moments moments;
  moments.area = pack_short_above(area);
  moments.second = pack_short_above(second);
  for (std::size_t axis = 0; axis < 3; ++axis)
    moments.vector[axis] = steps<std::int16_t>(sums.vector[static_cast<Eigen::Index>(axis)],
                                               moments.dipole_unit(), Moments::kDipoleSteps);
  const Eigen::Matrix3d& f = sums.first;
  const double third = f.trace() / 3;
  const double parts[] = {f(0, 0) - third, f(1, 1) - third, (f(0, 1) + f(1, 0)) * 0.5,
                          (f(1, 2) + f(2, 1)) * 0.5, (f(2, 0) + f(0, 2)) * 0.5};
  for (std::size_t i = 0; i < 5; ++i)
    moments.first[i] =
        steps<std::int8_t>(parts[i], moments.quadrupole_unit(), Moments::kQuadrupoleSteps);
  return moments;
}

TreeMoments sum_moments(const Triangles& mesh, const Point& centre,
                        const std::vector<MortonKey>& keys, const WideTree& tree,
                        const FloatBox& box) {
  return MomentSummer(mesh, centre, keys, tree).run(box);
}

}  // namespace planetree::octree
