#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "octree/geometry/triangle_distance.h"
#include "octree/page/moments.h"
#include "octree/traversal/bounds.h"

/// What a far point sees of a child, from the child's moments.
///
/// With q the query, c the centre of the child's box, d = c - q, x relative to c
/// and f(x) = (d + x) / |d + x|^3, the child's share of the winding number is
///
///     1 / (4 pi) integral of f . n  =  1 / (4 pi) (V . d / |d|^3
///                                      - 3 d^T F d / |d|^5) + error
///
/// where V is the integral of n and F that of x n^T, of which only the symmetric
/// part without its trace counts, because f is the gradient of a harmonic
/// function.
///
/// Error. The term of f that is homogeneous in x of degree k is at most
/// (k + 1) |x|^k / |d|^(k+2), for so large is the k-th derivative of 1 / |d|^2,
/// radially as in any direction (a symmetric tensor is largest on its diagonal,
/// Banach 1938). With s = R / |d|, R the half diagonal of the box and so at least
/// |x|, the terms from k = 2 on sum to
///
///     |x|^2 (3 - 2 s) / (1 - s)^2 / |d|^4,
///
/// and by Taylor's remainder they are also at most 3 |x|^2 / rho^4, rho being
/// the distance of q from the box, which holds the way from c to x. Integrated,
/// |x|^2 becomes the second moment. V is off by kVectorError of the area S, so
/// its term by kVectorError S / |d|^2; F by kFirstError units, so its term by 3
/// kFirstError units / |d|^3. Roundings in double are part of kVectorError.
///
/// Being relative to the model's centre moves the query by 2^-52 of its
/// greatest coordinate at most, and points of the triangles by kAbsoluteSlack / 2:
/// with delta the sum of both, that makes a difference of 2 delta S / (rho -
/// delta)^3.
///
/// The share itself is at most S / (4 pi rho^2). Where that is less than the
/// error, the share is taken for 0.
namespace planetree::octree {

class Multipoles {
 public:
  struct Share {
    double value;
    double error;  ///< above kMaxError: nothing is known
  };
  /// A share less certain than this decides nothing.
  static constexpr double kMaxError = 1;
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  Multipoles(const Point& query, const Point& centre)
      : from_(query - centre), moved_(kAbsoluteSlack + 0x1p-51 * from_.cwiseAbs().maxCoeff()) {}

  /// The shares of a node's children.
  void shares(const Node& node, std::array<Share, kFanOut>& shares) const {
    const NodeMoments& moments = NodeMoments::of(node);
    for (std::size_t child = 0; child < node.child_count; ++child)
      shares[child] = share(node, moments.child(child), child);
  }

 private:
  static constexpr double kOverFourPi = 0x1.45f306dc9c883p-4;

  Share share(const Node& node, const Moments& moments, std::size_t child) const;

  Point from_;    ///< relative to the model's centre
  double moved_;  ///< delta
};

inline Multipoles::Share Multipoles::share(const Node& node, const Moments& moments,
                                           std::size_t child) const {
  double gap2 = 0, extent2 = 0;
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
    gap2 += gap * gap;
    extent2 += extent * extent;
  }
  const double rho = std::sqrt(gap2) * (1 - 0x1p-48) - moved_;
  if (!(rho > 0x1p-60)) return {0, kUnknown};
  const double area = Moments::wide(moments.area), second = Moments::wide(moments.second);
  const double vector_unit = moments.vector_unit(), first_unit = moments.first_unit();
  const double over_way = 1 / way.norm(), over_rho = 1 / rho;
  const double over_rho2 = over_rho * over_rho;
  const double share = std::sqrt(extent2) * over_way;
  double tail = 3 * over_rho2 * over_rho2;
  if (share < 1)
    tail = std::min(tail, (3 - 2 * share) / ((1 - share) * (1 - share)) * over_way * over_way *
                              over_way * over_way);
  const double most = area * over_rho2;
  const double error = kVectorError * area * over_way * over_way +
                       3 * kFirstError * first_unit * over_way * over_way * over_way +
                       second * tail + 2 * moved_ * area * over_rho2 * over_rho;
  constexpr double kUp = kOverFourPi * (1 + 0x1p-40);
  if (most < error) return {0, kUp * most};
  const Point u = way * over_way;
  const auto& [xx, yy, xy, yz, zx] = moments.first;
  const double flux =
      u.x() * moments.vector[0] + u.y() * moments.vector[1] + u.z() * moments.vector[2];
  const double turn = u.x() * u.x() * xx + u.y() * u.y() * yy - u.z() * u.z() * (xx + yy) +
                      2 * (u.x() * u.y() * xy + u.y() * u.z() * yz + u.z() * u.x() * zx);
  return {
      kOverFourPi * over_way * over_way * (vector_unit * flux - 3 * first_unit * over_way * turn),
      kUp * error};
}

}  // namespace planetree::octree
