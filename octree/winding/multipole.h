#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/triangle_distance.h"
#include "octree/page/moments.h"
#include "octree/traversal/bounds.h"

/// A child's share of the winding number of a far point, from the child's moments.
///
/// Let q be the query, c the centre of the child's box, d = c - q, x a position relative to c, n
/// the normal there, and f(x) = (d + x) / |d + x|^3. The child's share of the winding number is
///
///     1 / (4 pi) integral of f . n  =  1 / (4 pi) (V . d / |d|^3
///                                      - 3 d^T F d / |d|^5) + error
///
/// where V, the dipole, is the integral of n and F, the quadrupole, that of x n^T. Only the
/// symmetric part of F without its trace counts, because f is the gradient of a harmonic function.
///
/// Error of the series. The term of f that is homogeneous of degree k in x is at most
/// (k + 1) |x|^k / |d|^(k+2): the k-th derivative of 1 / |d|^2, over k!, has that size along the
/// radius and is no larger in any other direction (a symmetric tensor is largest on its diagonal,
/// Banach 1938). Let R be half of the box's diagonal, which is at least |x|, and s = R / |d|. Then
/// the terms from k = 2 on sum to at most
///
///     |x|^2 (3 - 2 s) / (1 - s)^2 / |d|^4.
///
/// Let rho be the distance of q from the box. The box contains the segment from c to x. So, by
/// Taylor's remainder, the same terms are also at most 3 |x|^2 / rho^4. The integral of |x|^2 is
/// the second moment.
///
/// Error of the moments. V errs by kDipoleError times the area S, so that its term errs by
/// kDipoleError S / |d|^2. F errs by kQuadrupoleError units, so that its term errs by
/// 3 kQuadrupoleError units / |d|^3. Roundings in double are part of kDipoleError.
///
/// Error of positions. Positions are relative to the model's centre. Subtracting it moves the query
/// by at most 2^-52 of its greatest coordinate, and points of the triangles by kAbsoluteBoundSlack
/// / 2, or by 2^-52 of the box's greatest coordinate if it is of strays. With delta the sum of all,
/// the share errs by 2 delta S / (rho - delta)^3.
///
/// The share itself is at most S / (4 pi rho^2). Where that is less than the error, 0 is returned
/// as the share, with that bound as its error.
namespace planetree::octree {

class Multipoles {
 public:
  struct Share {
    double value;
    double error;  ///< above kMaxShareError: the share is unknown
  };
  /// A share of greater error decides nothing.
  static constexpr double kMaxShareError = 1;
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  Multipoles(const Point& query, const TreeInfo& tree)
      : from_(query - tree.centre),
        has_strays_(tree.has_strays),
        delta_(kAbsoluteBoundSlack + kMultipoleQueryRounding * from_.cwiseAbs().maxCoeff()) {}

  /// Computes the shares of a node's children.
  void shares(const Node& node, std::array<Share, kFanOut>& shares) const {
    const NodeMoments& moments = NodeMoments::of(node);
    for (std::size_t child = 0; child < node.child_count; ++child)
      shares[child] = share(node, moments.child(child), child);
  }

 private:
  static constexpr double kOverFourPi = 0x1.45f306dc9c883p-4;

  Share share(const Node& node, const Moments& moments, std::size_t child) const;

  Point from_;       ///< the query, relative to the model's centre
  bool has_strays_;  ///< positions may be far from the centre
  double delta_;     ///< delta of a child in the core
};

inline Multipoles::Share Multipoles::share(const Node& node, const Moments& moments,
                                           std::size_t child) const {
  double gap2 = 0, extent2 = 0, farthest = 0;
  Point way;
  const FloatBox box = child_box(node, child);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float low = box.lower[axis], high = box.upper[axis];
    const double lower = static_cast<double>(low), upper = static_cast<double>(high);
    const auto i = static_cast<Eigen::Index>(axis);
    const double middle = static_cast<double>((low + high) * 0.5f);
    const double gap = std::max({0.0, lower - from_[i], from_[i] - upper});
    const double extent = std::max(upper - middle, middle - lower);
    way[i] = middle - from_[i];
    farthest = std::max({farthest, std::fabs(lower), std::fabs(upper)});
    gap2 += gap * gap;
    extent2 += extent * extent;
  }
  const double delta = has_strays_ ? delta_ + kMultipoleQueryRounding * farthest : delta_;
  const double rho = std::sqrt(gap2) * (1 - kNormRounding) - delta;
  // The middle of a forged box may overflow.
  const double distance = way.norm();
  if (!(rho > kMultipoleMinDistance) || !(distance < kUnknown) || !moments.are_known())
    return {0, kUnknown};
  const double area = Moments::wide(moments.area), second = Moments::wide(moments.second);
  const double dipole_unit = moments.dipole_unit(), quadrupole_unit = moments.quadrupole_unit();
  const double over_way = 1 / distance, over_rho = 1 / rho;
  const double over_rho2 = over_rho * over_rho;
  const double share = std::sqrt(extent2) * over_way;
  double tail = 3 * over_rho2 * over_rho2;
  if (share < 1)
    tail = std::min(tail, (3 - 2 * share) / ((1 - share) * (1 - share)) * over_way * over_way *
                              over_way * over_way);
  const double max_share = area * over_rho2;
  const double error = kDipoleError * area * over_way * over_way +
                       3 * kQuadrupoleError * quadrupole_unit * over_way * over_way * over_way +
                       second * tail + 2 * delta * area * over_rho2 * over_rho;
  constexpr double kUp = kOverFourPi * kMultipoleErrorInflation;
  if (max_share < error) return {0, kUp * max_share};
  const Point u = way * over_way;
  const auto& [xx, yy, xy, yz, zx] = moments.first;
  const double dipole_term =
      u.x() * moments.vector[0] + u.y() * moments.vector[1] + u.z() * moments.vector[2];
  const double quadrupole_term = u.x() * u.x() * xx + u.y() * u.y() * yy -
                                 u.z() * u.z() * (xx + yy) +
                                 2 * (u.x() * u.y() * xy + u.y() * u.z() * yz + u.z() * u.x() * zx);
  return {kOverFourPi * over_way * over_way *
              (dipole_unit * dipole_term - 3 * quadrupole_unit * over_way * quadrupole_term),
          kUp * error};
}

}  // namespace planetree::octree
