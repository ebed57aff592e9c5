#include "octree/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <Eigen/Geometry>

#include "octree/strict_math.h"
#include "octree/vector3.h"

namespace planetree::octree {
namespace {

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
// A point inside a face has a share of every corner, though it may round to 0.
constexpr double kLeastShare = 0x1p-54;
// Squares below 2^-1022 underflow; distances below this are not resolved.
constexpr double kAbsoluteError = 0x1p-500;

// Lexicographic order, without branches: which corner comes first is a coin
// toss to the processor.
unsigned before(const Point& a, const Point& b) {
  const unsigned x_less = a.x() < b.x(), x_same = a.x() == b.x();
  const unsigned y_less = a.y() < b.y(), y_same = a.y() == b.y();
  const unsigned z_less = a.z() < b.z();
  return x_less | (x_same & (y_less | (y_same & z_less)));
}

// order[k] is the corner that comes k-th; equal corners keep their order.
std::array<int, 3> lexicographic_order(const Triangle& triangle) {
  const unsigned swapped01 = before(triangle[1], triangle[0]);
  const unsigned swapped02 = before(triangle[2], triangle[0]);
  const unsigned swapped12 = before(triangle[2], triangle[1]);
  std::array<int, 3> order{};
  order[swapped01 + swapped02] = 0;
  order[1 - swapped01 + swapped12] = 1;
  order[2 - swapped02 - swapped12] = 2;
  return order;
}

// Nearest point of a segment from u to v: at u + t (v - u).
struct OnSegment {
  double squared;
  double t;
};

// Without branches, too. t = 0 leaves the bits of u's distance as they are,
// t = 1 takes v's: a vertex is equally far whichever edge it is seen from.
OnSegment on_segment(const Point& to_u, double to_v2, const Point& edge, double edge2) {
  const double along = -to_u.dot(edge);
  const double share = along > 0 ? along / edge2 : 0;
  const double t = share < 1 ? share : 1;
  const double inner2 = (to_u + t * edge).squaredNorm();
  return {t < 1 ? inner2 : to_v2, t};
}

// Nearest point inside the face, at
// apex + v / whole (first - apex) + w / whole (second - apex).
struct OnFace {
  bool inside = false;
  double squared = 0;
  double v = 0, w = 0, whole = 1;
  double inverse_sine2 = 1;
};

// The face's part given its edges from the apex; `normal2` > 0.
template <class Scalar>
OnFace project(const Vector3<Scalar>& e1, const Vector3<Scalar>& e2, const Vector3<Scalar>& normal,
               const Scalar& normal2, const Vector3<Scalar>& from_apex) {
  const Scalar v = dot(cross(from_apex, e2), normal);
  const Scalar w = dot(cross(e1, from_apex), normal);
  const Scalar height = dot(from_apex, normal);
  OnFace face;
  const unsigned beside = v > 0, above = w > 0, below = v + w < normal2;
  face.inside = (beside & above & below) != 0;
  // Not height * height: above a face of short edges that underflows.
  face.squared = static_cast<double>(height / normal2 * height);
  if constexpr (std::is_same_v<Scalar, double>) {
    face.v = v;
    face.w = w;
    face.whole = normal2;
  } else {
    // Products of four short edges are no doubles, their ratios are.
    face.v = static_cast<double>(v / normal2);
    face.w = static_cast<double>(w / normal2);
    face.whole = 1;
  }
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
  face.inverse_sine2 = edges2 / normal2;
  return face;
}

// All that the value needs, over corners in lexicographic order.
struct Evaluation {
  std::array<int, 3> order;        // order[k] is the caller's corner k-th in order
  std::array<Point, 3> corner;     // in order
  std::array<OnSegment, 3> edges;  // opposite to each corner: 12, 02, 01
  int apex = 0;
  OnFace face;
  double corner2_max = 0;

  Evaluation(const Point& query, const Triangle& triangle);
  int nearest_edge() const {
    const int first = edges[1].squared < edges[0].squared ? 1 : 0;
    return edges[2].squared < edges[first].squared ? 2 : first;
  }
  TriangleValue value() const {
    return {on_face() ? face.squared : edges[nearest_edge()].squared,
            kErrorFactor * std::sqrt(corner2_max * face.inverse_sine2) + kAbsoluteError};
  }
  bool on_face() const { return face.inside && face.squared <= edges[nearest_edge()].squared; }
};

constexpr int kFirst[3] = {1, 0, 0};
constexpr int kSecond[3] = {2, 2, 1};

Evaluation::Evaluation(const Point& query, const Triangle& triangle)
    : order(lexicographic_order(triangle)) {
  std::array<Point, 3> to;
  std::array<double, 3> to2;
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    corner[k] = triangle[order[k]];
    to[k] = corner[k] - query;
    to2[k] = to[k].squaredNorm();
  }
  corner2_max = std::max({to2[0], to2[1], to2[2]});
  double longest2 = -1;
#pragma GCC unroll 3
  for (int k = 0; k < 3; ++k) {
    const Point edge = corner[kSecond[k]] - corner[kFirst[k]];
    const double edge2 = edge.squaredNorm();
    edges[k] = on_segment(to[kFirst[k]], to2[kSecond[k]], edge, edge2);
    apex = edge2 > longest2 ? k : apex;
    longest2 = std::max(longest2, edge2);
  }
  face = octree::on_face(query, corner[apex], corner[kFirst[apex]], corner[kSecond[apex]]);
}

void place_on_face(const Evaluation& e, NearestOnTriangle& nearest) {
  const Point& apex = e.corner[e.apex];
  const Point first = e.corner[kFirst[e.apex]] - apex;
  const Point second = e.corner[kSecond[e.apex]] - apex;
  nearest.feature = Feature::kFace;
  const double v = e.face.v / e.face.whole;
  const double w = e.face.w / e.face.whole;
  nearest.point = apex + (v * first + w * second);
  nearest.barycentric[e.order[e.apex]] = std::max((1 - v) - w, kLeastShare);
  nearest.barycentric[e.order[kFirst[e.apex]]] = std::max(v, kLeastShare);
  nearest.barycentric[e.order[kSecond[e.apex]]] = std::max(w, kLeastShare);
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

TriangleValue triangle_value(const Point& query, const Triangle& triangle) noexcept {
  return Evaluation(query, triangle).value();
}

NearestOnTriangle nearest_on_triangle(const Point& query, const Triangle& triangle) noexcept {
  const Evaluation evaluation(query, triangle);
  NearestOnTriangle nearest;
  nearest.value = evaluation.value();
  if (evaluation.on_face())
    place_on_face(evaluation, nearest);
  else
    place_on_edge(evaluation, nearest);
  return nearest;
}

}  // namespace planetree::octree
