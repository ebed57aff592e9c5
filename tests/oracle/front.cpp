#include "tests/oracle/front.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "tests/oracle/pseudo_normal.h"

namespace planetree::oracle {
namespace {

using Wide3 = std::array<Wide, 3>;

Wide3 wide(const Vec3& a) { return {Wide(a.x), Wide(a.y), Wide(a.z)}; }
Wide3 operator-(const Wide3& a, const Wide3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Wide dot(const Wide3& a, const Wide3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Wide3 cross(const Wide3& u, const Wide3& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

struct Nearest {
  std::uint64_t triangle = 0;
  std::array<Wide, 3> shares;  // barycentric coordinates; 0 is exact
  Wide3 way;                   // from the nearest point to the query
  Wide squared;
};

void offer(const std::array<Wide, 3>& shares, const std::array<Wide3, 3>& corners,
           const Wide3& query, bool& has_best, Nearest& best) {
  Wide3 at{0, 0, 0};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) at[axis] += shares[k] * corners[k][axis];
  const Wide3 way = query - at;
  const Wide squared = dot(way, way);
  if (has_best && squared >= best.squared) return;
  has_best = true;
  best.shares = shares;
  best.way = way;
  best.squared = squared;
}

// Nearest point of a triangle that has area or not: the least of its corners, of the feet on its
// edges that are within them, and of the foot on its plane if that is inside.
Nearest nearest_on(const Vec3& point, const Corners& triangle) {
  const Wide3 query = wide(point);
  const std::array<Wide3, 3> corners{wide(triangle[0]), wide(triangle[1]), wide(triangle[2])};
  Nearest best;
  bool has_best = false;
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<Wide, 3> shares{0, 0, 0};
    shares[k] = 1;
    offer(shares, corners, query, has_best, best);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Wide3 edge = corners[next] - corners[k];
    const Wide length2 = dot(edge, edge);
    const Wide along = dot(query - corners[k], edge);
    if (!(along > 0 && along < length2)) continue;
    std::array<Wide, 3> shares{0, 0, 0};
    shares[next] = along / length2;
    shares[k] = 1 - shares[next];
    offer(shares, corners, query, has_best, best);
  }
  const Wide3 u = corners[1] - corners[0], v = corners[2] - corners[0], w = query - corners[0];
  const Wide3 normal = cross(u, v);
  const Wide area2 = dot(normal, normal);
  if (area2 == 0) return best;
  const Wide second = dot(cross(w, v), normal) / area2, third = dot(cross(u, w), normal) / area2;
  const Wide first = 1 - second - third;
  if (first > 0 && second > 0 && third > 0)
    offer({first, second, third}, corners, query, has_best, best);
  return best;
}

// Returns 1 in front, -1 behind, 0 if that is not certain.
int sign_at(const Nearest& nearest, std::span<const Corners> triangles) {
  // Only zeros matter to reference_normal(), but a tiny share must not become one.
  const auto share = [&nearest](std::size_t k) { return nearest.shares[k] > 0 ? 0.5 : 0.0; };
  const ReferenceNormal reference =
      reference_normal(triangles, nearest.triangle, {share(0), share(1), share(2)});
  if (reference.certainty < 1e-6) return 0;
  const Wide along = dot(nearest.way, wide(reference.normal));
  const Wide limit = Wide(1e-13) * sqrt(nearest.squared);
  return along > limit ? 1 : along < -limit ? -1 : 0;
}

}  // namespace

FrontAnswer front_side(const Vec3& query, std::span<const Corners> triangles) {
  std::vector<long double> rough;
  rough.reserve(triangles.size());
  for (const Corners& triangle : triangles) rough.push_back(extended_distance(query, triangle));
  const long double least = *std::min_element(rough.begin(), rough.end());
  std::vector<Nearest> found;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (rough[i] > least * (1 + 1e-12L) + 1e-15L) continue;
    found.push_back(nearest_on(query, triangles[i]));
    found.back().triangle = i;
  }
  Wide best = found[0].squared;
  for (const Nearest& nearest : found) best = std::min(best, nearest.squared);
  if (best == 0) return {Side::kOnSurface, false};
  int sign = 2;
  for (const Nearest& nearest : found) {
    if (nearest.squared > best * (1 + Wide(1e-14))) continue;
    const int its = sign_at(nearest, triangles);
    if (its == 0 || (sign != 2 && its != sign)) return {Side::kUnknown, true};
    sign = its;
  }
  return {sign > 0 ? Side::kOutside : Side::kInside, false};
}

}  // namespace planetree::oracle
