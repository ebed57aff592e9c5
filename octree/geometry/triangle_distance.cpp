#include "octree/geometry/triangle_distance.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/geometry/triangle_distance.cpp"
#include <hwy/foreach_target.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/geometry/triangle_kernels-inl.h"
#include "octree/geometry/wide_numbers.h"
#include "octree/geometry/work_limit.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

// Returns whether the limit sufficed for the first triangle.
bool evaluate_on_target(const Point& query, const TriangleView& triangles, WorkLimit& limit,
                        TriangleResults& results) {
  return evaluate_selected(triangles, 1, query, limit, results) == 0;
}

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {
namespace {

HWY_EXPORT(evaluate_on_target);

// Minimum barycentric coordinate of a point inside a face. The true one is positive but may round
// to 0.
constexpr double kMinBarycentric = 0x1p-54;

// The other two corners of corner k, in order.
constexpr std::size_t kFirst[3] = {1, 0, 0};
constexpr std::size_t kSecond[3] = {2, 2, 1};

unsigned before(const Point& a, const Point& b) {
  const unsigned x_less = a.x() < b.x(), x_same = a.x() == b.x();
  const unsigned y_less = a.y() < b.y(), y_same = a.y() == b.y();
  const unsigned z_less = a.z() < b.z();
  return x_less | (x_same & (y_less | (y_same & z_less)));
}

// order[k] is the corner that comes k-th in lexicographic order; equal corners keep their order.
// Computed without branches because the processor cannot predict the outcome.
std::array<std::size_t, 3> lexicographic_order(const Triangle& triangle) {
  const unsigned swapped01 = before(triangle[1], triangle[0]);
  const unsigned swapped02 = before(triangle[2], triangle[0]);
  const unsigned swapped12 = before(triangle[2], triangle[1]);
  std::array<std::size_t, 3> order{};
  order[swapped01 + swapped02] = 0;
  order[1 - swapped01 + swapped12] = 1;
  order[2 - swapped02 - swapped12] = 2;
  return order;
}

// Returns the corner opposite to the longest side, the first of equal ones.
std::size_t apex_of(const std::array<Point, 3>& corner) {
  std::size_t apex = 0;
  double longest2 = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double edge2 = (corner[kSecond[k]] - corner[kFirst[k]]).squaredNorm();
    apex = edge2 > longest2 ? k : apex;
    longest2 = std::max(longest2, edge2);
  }
  return apex;
}

// Evaluates the face of a triangle again with 113 bits, after double found it too flat.
void refine_face(const Point& query, const Triangle& triangle, TriangleResults& results,
                 std::size_t lane) {
  const auto order = lexicographic_order(triangle);
  const std::array<Point, 3> corner{triangle[order[0]], triangle[order[1]], triangle[order[2]]};
  const std::size_t apex = apex_of(corner);
  const auto e1 = difference<Quad>(corner[kFirst[apex]], corner[apex]);
  const auto e2 = difference<Quad>(corner[kSecond[apex]], corner[apex]);
  const auto normal = cross(e1, e2);
  const Quad normal2 = dot(normal, normal);
  if (!(normal2 > kDegenerateFaceSine2 * dot(e1, e1) * dot(e2, e2))) return;
  const auto from_apex = difference<Quad>(query, corner[apex]);
  const Quad v = dot(cross(from_apex, e2), normal);
  const Quad w = dot(cross(e1, from_apex), normal);
  if (!(v > 0 && w > 0 && v + w < normal2)) return;
  const Quad height = dot(from_apex, normal);
  const auto squared = static_cast<double>(height / normal2 * height);
  if (!(squared <= results.squared[lane])) return;
  results.squared[lane] = squared;
  results.number[lane] = static_cast<double>(apex);
  results.first[lane] = static_cast<double>(v / normal2);
  results.second[lane] = static_cast<double>(w / normal2);
}

}  // namespace

void refine_flat(const Point& query, const TriangleView& triangles, unsigned triangle,
                 TriangleResults& results) noexcept {
  const auto lane = static_cast<unsigned>(std::countr_zero(triangle));
  refine_face(query, triangles.triangle(lane), results, lane);
}

void locate(const Triangle& triangle, const TriangleResult& result,
            NearestOnTriangle& nearest) noexcept {
  nearest.value = result.value;
  nearest.barycentric = {};
  const auto order = lexicographic_order(triangle);
  const auto number = static_cast<std::size_t>(result.number);
  const std::size_t first = order[kFirst[number]], second = order[kSecond[number]];
  const Point& u = triangle[first];
  const Point& v = triangle[second];
  const double a = result.first, b = result.second;
  if (b == TriangleResult::kOnSide) {
    nearest.feature = a == 0 || a == 1 ? Feature::kVertex : Feature::kEdge;
    nearest.point = a == 0 ? u : a == 1 ? v : Point(u + a * (v - u));
    nearest.barycentric[first] = 1 - a;
    nearest.barycentric[second] = a;
    return;
  }
  const Point& apex = triangle[order[number]];
  nearest.feature = Feature::kFace;
  nearest.point = apex + (a * (u - apex) + b * (v - apex));
  nearest.barycentric[order[number]] = std::max((1 - a) - b, kMinBarycentric);
  nearest.barycentric[first] = std::max(a, kMinBarycentric);
  nearest.barycentric[second] = std::max(b, kMinBarycentric);
}

bool may_be_flat(const Triangle& triangle) noexcept {
  constexpr double kMargin = 2;  // rounding, by far
  const std::array<Point, 3> corner{triangle[0], triangle[1], triangle[2]};
  const std::size_t apex = apex_of(corner);
  const Point u = corner[kFirst[apex]] - corner[apex], v = corner[kSecond[apex]] - corner[apex];
  const Point normal(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(),
                     u.x() * v.y() - u.y() * v.x());
  const double normal2 = normal.squaredNorm();
  return !(normal2 > kMargin * kMinFaceSine2 * u.squaredNorm() * v.squaredNorm() &&
           normal2 > kMargin * kMinFaceNormal2);
}

bool nearest_on_triangle(const Point& query, const Triangle& triangle, WorkLimit& limit,
                         NearestOnTriangle& nearest) noexcept {
  TriangleRows<kTrianglesAtOnce> rows;
  rows.fill(0, triangle);
  TriangleResults results;
  if (!HWY_DYNAMIC_DISPATCH(evaluate_on_target)(query, rows.view(0), limit, results)) return false;
  locate(triangle, results.of(0), nearest);
  return true;
}

NearestOnTriangle nearest_on_triangle(const Point& query, const Triangle& triangle) noexcept {
  std::uint64_t units = 0;
  WorkLimit limit(units, WorkLimit::kNone);
  NearestOnTriangle nearest;
  nearest_on_triangle(query, triangle, limit, nearest);
  return nearest;
}

}  // namespace planetree::octree
#endif
