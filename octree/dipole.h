#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "octree/bounds.h"
#include "octree/moments.h"

/// What a far point sees of a child, from the child's moments.
///
/// With q the query, c the centre of the child's box, f(x) = (x - q) / |x - q|^3
/// and A the sum of the triangles' area vectors, the winding number's share is
///
///     1 / (4 pi) integral of f(x) . dA  =  f(c) . A / (4 pi)  +  error.
///
/// Error. The derivative of f is 2 / |x - q|^3 at most, in any direction. Box
/// and triangles are convex and c lies in the box, so no point between c and a
/// triangle's is nearer to q than the box is: rho. So the error is at most
///
///     2 M / (4 pi rho^3),   M = integral of |x - c| |dA|  <=  spread.
///
/// Besides, A is known to 2^-22 of the area S (kVectorError), and the value
/// below is rounded to 2^-45 of S / (4 pi rho^2); 2^-21 S / (4 pi rho^2) pays
/// for both. Being relative to the model's centre moves the query by 2^-52 of its
/// greatest coordinate at most, and points of the triangles by kAbsoluteSlack / 2:
/// with delta the sum of both, that is as if the spread were larger by delta S
/// and rho less by delta.
///
/// The share itself is at most S / (4 pi rho^2). Where that is less than the
/// error, the share is taken for 0.
namespace planetree::octree {

class Dipoles {
 public:
  struct Share {
    double value;
    double error;  ///< above kMostError: nothing is known
  };
  /// A share less certain than this decides nothing.
  static constexpr double kMostError = 1;
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  Dipoles(const Point& query, const Point& centre)
      : from_(query - centre),
        moved_(kAbsoluteSlack + 0x1p-51 * from_.cwiseAbs().maxCoeff()) {}

  /// The shares of a node's children.
  void shares(const Node& node, std::array<Share, kFanOut>& shares) const {
    const NodeMoments& moments = NodeMoments::of(node);
    for (std::size_t child = 0; child < node.child_count; ++child)
      shares[child] = share(node, moments, child);
  }

 private:
  Share share(const Node& node, const NodeMoments& moments, std::size_t child) const;

  Point from_;    ///< relative to the model's centre
  double moved_;  ///< delta
};

inline Dipoles::Share Dipoles::share(const Node& node, const NodeMoments& moments,
                                     std::size_t child) const {
  constexpr double kOverFourPi = 0x1.45f306dc9c883p-4;
  double gap2 = 0, way2 = 0, flux = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float lower = node.lower[axis][child], upper = node.upper[axis][child];
    const double at = from_[static_cast<Eigen::Index>(axis)];
    const double gap =
        std::max({0.0, static_cast<double>(lower) - at, at - static_cast<double>(upper)});
    const double way = static_cast<double>((lower + upper) * 0.5f) - at;
    gap2 += gap * gap;
    way2 += way * way;
    flux += way * static_cast<double>(moments.vector[axis][child]);
  }
  const double rho = std::sqrt(gap2) * (1 - 0x1p-48) - moved_;
  if (!(rho > 0x1p-60)) return {0, kUnknown};
  const double area = static_cast<double>(unpack_short(moments.area[child]));
  const double spread = static_cast<double>(unpack_short(moments.spread[child]));
  const double over_rho = 1 / rho;
  const double most = kOverFourPi * area * over_rho * over_rho;
  const double error =
      2 * kOverFourPi * (spread + moved_ * area) * over_rho * over_rho * over_rho + 0x1p-21 * most;
  if (most < error) return {0, most * (1 + 0x1p-40)};
  return {kOverFourPi * flux / (way2 * std::sqrt(way2)), error * (1 + 0x1p-40)};
}

}  // namespace planetree::octree
