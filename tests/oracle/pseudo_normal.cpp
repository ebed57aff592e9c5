#include "tests/oracle/pseudo_normal.h"

#include <array>
#include <cmath>
#include <vector>

namespace planetree::oracle {
namespace {

using Long3 = std::array<long double, 3>;
using Wide3 = std::array<Wide, 3>;

Wide3 from_to(const Vec3& from, const Vec3& to) {
  return {Wide(to.x) - Wide(from.x), Wide(to.y) - Wide(from.y), Wide(to.z) - Wide(from.z)};
}

Wide3 cross(const Wide3& u, const Wide3& v) {
  return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

Wide dot(const Wide3& u, const Wide3& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }

bool same(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// Adds the face's unit normal, if it has one, weighted by the angle at a corner or by 1.
void add_face(const Corners& t, std::size_t corner, bool by_angle, Long3& sum,
              long double& weights) {
  const Wide3 u = from_to(t[corner], t[(corner + 1) % 3]);
  const Wide3 v = from_to(t[corner], t[(corner + 2) % 3]);
  const Wide3 normal = cross(u, v);
  const Wide length = sqrt(dot(normal, normal));
  if (length == 0) return;
  long double weight = 1;
  if (by_angle) {
    const Wide size = sqrt(dot(u, u) * dot(v, v));
    weight = std::atan2(static_cast<long double>(Wide(length / size)),
                        static_cast<long double>(Wide(dot(u, v) / size)));
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    sum[axis] += weight * static_cast<long double>(Wide(normal[axis] / length));
  weights += weight;
}

}  // namespace

ReferenceNormal reference_normal(std::span<const Corners> triangles, std::uint64_t triangle,
                                 const Vec3& barycentric) {
  const Corners& nearest = triangles[triangle];
  const double shares[3] = {barycentric.x, barycentric.y, barycentric.z};
  std::vector<Vec3> ends;
  for (std::size_t corner = 0; corner < 3; ++corner)
    if (shares[corner] > 0) ends.push_back(nearest[corner]);
  Long3 sum{};
  long double weights = 0;
  if (ends.size() == 3) add_face(nearest, 0, false, sum, weights);
  for (const Corners& t : triangles)
    for (std::size_t corner = 0; corner < 3 && ends.size() < 3; ++corner) {
      if (!same(t[corner], ends[0])) continue;
      const bool has_edge = ends.size() == 2 && (same(t[(corner + 1) % 3], ends[1]) ||
                                                 same(t[(corner + 2) % 3], ends[1]));
      if (ends.size() == 1 || has_edge) add_face(t, corner, ends.size() == 1, sum, weights);
    }
  const long double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  if (weights == 0 || length == 0) return {};
  return {{static_cast<double>(sum[0] / length), static_cast<double>(sum[1] / length),
           static_cast<double>(sum[2] / length)},
          static_cast<double>(length / weights)};
}

}  // namespace planetree::oracle
