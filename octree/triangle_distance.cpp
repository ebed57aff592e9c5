#include "octree/triangle_distance.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

using Quad = boost::multiprecision::cpp_bin_float_quad;

// Below this squared sine the face is evaluated with 113 bits.
constexpr double kFlatSine2 = 0x1p-10;
// Below this squared sine the face is its edges, to 2^-50 of their length.
constexpr double kDegenerateSine2 = 0x1p-100;
// |n|^2 below this has lost bits to underflow.
constexpr double kTinySquare = 0x1p-930;
// Rounding of the algorithm below, as a multiple of (greatest corner distance)
// / sine: the cross product loses 5 units of 2^-53, its dot products 3 more
// each, the inside test 2 * (4 + 5) across an edge; 64 covers their sum.
constexpr double kErrorFactor = 64 * 0x1p-53;
// Squares below 2^-1022 underflow; distances below this are not resolved.
constexpr double kAbsoluteError = 0x1p-500;

bool before(const Point& left, const Point& right) {
  return std::lexicographical_compare(left.data(), left.data() + 3, right.data(),
                                      right.data() + 3);
}

// Nearest point of a segment from u to v: at u + t (v - u).
struct OnSegment {
  double squared;
  double t;
};

OnSegment on_segment(const Point& to_u, const Point& to_v, const Point& edge, double edge2) {
  const double along = -to_u.dot(edge);
  if (!(along > 0)) return {to_u.squaredNorm(), 0};
  if (!(along < edge2)) return {to_v.squaredNorm(), 1};
  const double t = along / edge2;
  return {(to_u + t * edge).squaredNorm(), t};
}

// Nearest point inside the face: at apex + v (first - apex) + w (second - apex).
struct OnFace {
  bool inside = false;
  double squared = 0;
  double v = 0, w = 0;
  double inverse_sine = 1;
};

template <class Scalar>
using Vector = std::array<Scalar, 3>;

template <class Scalar>
Vector<Scalar> cross(const Vector<Scalar>& a, const Vector<Scalar>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Scalar>
Scalar dot(const Vector<Scalar>& a, const Vector<Scalar>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Scalar>
Vector<Scalar> difference(const Point& a, const Point& b) {
  return {Scalar(a.x()) - Scalar(b.x()), Scalar(a.y()) - Scalar(b.y()),
          Scalar(a.z()) - Scalar(b.z())};
}

// The face's part given its edges from the apex; `normal2` > 0.
template <class Scalar>
OnFace project(const Vector<Scalar>& e1, const Vector<Scalar>& e2, const Vector<Scalar>& normal,
               const Scalar& normal2, const Vector<Scalar>& from_apex) {
  OnFace face;
  const Scalar v = dot(cross(from_apex, e2), normal);
  const Scalar w = dot(cross(e1, from_apex), normal);
  if (!(v > 0 && w > 0 && v + w < normal2)) return face;
  const Scalar height = dot(from_apex, normal);
  face.inside = true;
  face.squared = static_cast<double>(height * height / normal2);
  face.v = static_cast<double>(v / normal2);
  face.w = static_cast<double>(w / normal2);
  return face;
}

OnFace on_flat_face(const Point& query, const Point& apex, const Point& first,
                    const Point& second) {
  const auto e1 = difference<Quad>(first, apex);
  const auto e2 = difference<Quad>(second, apex);
  const auto normal = cross(e1, e2);
  const Quad normal2 = dot(normal, normal);
  if (!(normal2 > kDegenerateSine2 * dot(e1, e1) * dot(e2, e2))) return {};
  return project(e1, e2, normal, normal2, difference<Quad>(query, apex));
}

OnFace on_face(const Point& query, const Point& apex, const Point& first, const Point& second) {
  const auto e1 = difference<double>(first, apex);
  const auto e2 = difference<double>(second, apex);
  const auto normal = cross(e1, e2);
  const double normal2 = dot(normal, normal);
  const double edges2 = dot(e1, e1) * dot(e2, e2);
  if (!(normal2 >= kFlatSine2 * edges2 && normal2 >= kTinySquare))
    return on_flat_face(query, apex, first, second);
  OnFace face = project(e1, e2, normal, normal2, difference<double>(query, apex));
  face.inverse_sine = std::sqrt(edges2 / normal2);
  return face;
}

// All that the value needs, over corners in lexicographic order.
struct Evaluation {
  std::array<int, 3> order;         // order[k] is the caller's corner k-th in order
  std::array<Point, 3> corner;      // in order
  std::array<OnSegment, 3> edges;   // opposite to each corner: 12, 02, 01
  int apex = 0;
  OnFace face;
  double corner2_max = 0;

  Evaluation(const Point& query, const Triangle& triangle);
  int nearest_edge() const {
    int best = 0;
    for (int k = 1; k < 3; ++k)
      if (edges[k].squared < edges[best].squared) best = k;
    return best;
  }
  bool on_face() const { return face.inside && face.squared <= edges[nearest_edge()].squared; }
  double squared() const { return on_face() ? face.squared : edges[nearest_edge()].squared; }
};

constexpr int kFirst[3] = {1, 0, 0};
constexpr int kSecond[3] = {2, 2, 1};

Evaluation::Evaluation(const Point& query, const Triangle& triangle) : order{0, 1, 2} {
  const auto swap_if_after = [&](int i, int j) {
    if (before(triangle[order[j]], triangle[order[i]])) std::swap(order[i], order[j]);
  };
  swap_if_after(0, 1);
  swap_if_after(1, 2);
  swap_if_after(0, 1);
  std::array<Point, 3> to;
  for (int k = 0; k < 3; ++k) {
    corner[k] = triangle[order[k]];
    to[k] = corner[k] - query;
    corner2_max = std::max(corner2_max, to[k].squaredNorm());
  }
  double longest2 = -1;
  for (int k = 0; k < 3; ++k) {
    const Point edge = corner[kSecond[k]] - corner[kFirst[k]];
    const double edge2 = edge.squaredNorm();
    edges[k] = on_segment(to[kFirst[k]], to[kSecond[k]], edge, edge2);
    if (edge2 > longest2) {
      longest2 = edge2;
      apex = k;
    }
  }
  face = octree::on_face(query, corner[apex], corner[kFirst[apex]], corner[kSecond[apex]]);
}

void place_on_face(const Evaluation& e, NearestOnTriangle& nearest) {
  const Point& apex = e.corner[e.apex];
  const Point first = e.corner[kFirst[e.apex]] - apex;
  const Point second = e.corner[kSecond[e.apex]] - apex;
  nearest.feature = Feature::kFace;
  nearest.point = apex + (e.face.v * first + e.face.w * second);
  nearest.barycentric[e.order[e.apex]] = (1 - e.face.v) - e.face.w;
  nearest.barycentric[e.order[kFirst[e.apex]]] = e.face.v;
  nearest.barycentric[e.order[kSecond[e.apex]]] = e.face.w;
}

void place_on_edge(const Evaluation& e, NearestOnTriangle& nearest) {
  const int edge = e.nearest_edge();
  const double t = e.edges[edge].t;
  const Point& u = e.corner[kFirst[edge]];
  const Point& v = e.corner[kSecond[edge]];
  nearest.feature = t == 0 || t == 1 ? Feature::kVertex : Feature::kEdge;
  nearest.point = t == 0 ? u : t == 1 ? v : Point(u + t * (v - u));
  nearest.barycentric[e.order[kFirst[edge]]] = 1 - t;
  nearest.barycentric[e.order[kSecond[edge]]] = t;
}

}  // namespace

double squared_distance(const Point& query, const Triangle& triangle) noexcept {
  return Evaluation(query, triangle).squared();
}

NearestOnTriangle nearest_on_triangle(const Point& query, const Triangle& triangle) noexcept {
  const Evaluation evaluation(query, triangle);
  NearestOnTriangle nearest;
  nearest.squared = evaluation.squared();
  nearest.error = kErrorFactor * std::sqrt(evaluation.corner2_max) * evaluation.face.inverse_sine +
                  kAbsoluteError;
  if (evaluation.on_face())
    place_on_face(evaluation, nearest);
  else
    place_on_edge(evaluation, nearest);
  return nearest;
}

}  // namespace planetree::octree
