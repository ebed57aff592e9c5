#include "tests/oracle/ray_crossing.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace planetree::oracle {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// Projection along the ray: y and z.
Kernel::Point_2 seen(const Vec3& p) { return {p.y, p.z}; }
Kernel::Point_3 to_point(const Vec3& p) { return {p.x, p.y, p.z}; }

int sign(double value) { return (value > 0) - (value < 0); }

// Side of the projected line from a to b on which the query lies, once it is moved by (e, e * e) in
// y and z with e infinitesimal. 0 where a and b project to one point.
int perturbed_side(const Vec3& a, const Vec3& b, const Vec3& query) {
  const auto side = static_cast<int>(CGAL::orientation(seen(a), seen(b), seen(query)));
  if (side != 0) return side;
  return a.z != b.z ? sign(a.z - b.z) : sign(b.y - a.y);
}

}  // namespace

int ray_crossing(const Vec3& query, const Corners& t) {
  const int side = perturbed_side(t[0], t[1], query);
  if (side == 0 || perturbed_side(t[1], t[2], query) != side ||
      perturbed_side(t[2], t[0], query) != side)
    return 0;
  // The projection is counterclockwise where the triangle's normal points along the ray.
  const auto height = static_cast<int>(
      CGAL::orientation(to_point(t[0]), to_point(t[1]), to_point(t[2]), to_point(query)));
  return height == -side ? side : 0;
}

}  // namespace planetree::oracle
