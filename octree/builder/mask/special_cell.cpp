#include "octree/builder/mask/special_cell.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "octree/geometry/predicates.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

int side_of(const Triangle& plane, const Point& point) {
  return orientation(plane[0], plane[1], plane[2], point);
}

std::array<int, 3> normal_signs(const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  return {normal_sign(a, b, c, 0), normal_sign(a, b, c, 1), normal_sign(a, b, c, 2)};
}

/// The sides of a plane that a triangle reaches.
struct Reach {
  bool behind = false;
  bool beyond = false;
};

Reach reach_of(const Triangle& plane, const Triangle& triangle) {
  Reach reach;
  for (const Point& corner : triangle) {
    const int side = side_of(plane, corner);
    reach.behind = reach.behind || side < 0;
    reach.beyond = reach.beyond || side > 0;
  }
  return reach;
}

/// The distinct planes of some triangles, as long as they are few.
class Planes {
 public:
  /// False if some triangle cannot be part of a special cell.
  bool add_all(std::span<const Triangle> triangles) {
    return std::all_of(triangles.begin(), triangles.end(),
                       [this](const Triangle& triangle) { return add(triangle); });
  }

  bool add(const Triangle& triangle) {
    const std::array<int, 3> signs = normal_signs(triangle);
    if (signs == std::array<int, 3>{}) return false;
    for (unsigned i = 0; i < cell_.plane_count; ++i) {
      const Reach reach = reach_of(cell_.planes[i], triangle);
      // Between two triangles back to back there is no inside.
      if (!reach.behind && !reach.beyond) return signs == normal_signs(cell_.planes[i]);
    }
    if (cell_.plane_count == kMaxPlanes) return false;
    cell_.planes[cell_.plane_count++] = triangle;
    return true;
  }

  /// Whether all triangles are on or behind all planes. If all are on or beyond them, the planes
  /// are reversed.
  bool enclose(std::span<const Triangle> triangles) {
    Reach reach;
    for (const Triangle& triangle : triangles)
      for (unsigned i = 0; i < cell_.plane_count; ++i) {
        const Reach one = reach_of(cell_.planes[i], triangle);
        reach.behind = reach.behind || one.behind;
        reach.beyond = reach.beyond || one.beyond;
        if (reach.behind && reach.beyond) return false;
      }
    if (reach.beyond)
      for (unsigned i = 0; i < cell_.plane_count; ++i)
        std::swap(cell_.planes[i][1], cell_.planes[i][2]);
    return true;
  }

  SpecialCell& cell() { return cell_; }

 private:
  SpecialCell cell_;
};

/// Finds the two winding numbers. False if the corners do not tell them.
bool settle(SpecialCell& cell, const std::array<Point, 8>& corners,
            const std::array<std::int64_t, 8>& winding) {
  std::optional<std::int64_t> behind, beyond;
  std::array<bool, kMaxPlanes> passed{};
  for (unsigned corner = 0; corner < 8; ++corner) {
    int farthest = -1;
    for (unsigned i = 0; i < cell.plane_count; ++i) {
      const int side = side_of(cell.planes[i], corners[corner]);
      passed[i] = passed[i] || side > 0;
      farthest = std::max(farthest, side);
    }
    if (farthest == 0) continue;
    std::optional<std::int64_t>& number = farthest > 0 ? beyond : behind;
    if (number && *number != winding[corner]) return false;
    number = winding[corner];
  }
  const auto first_unused = passed.begin() + cell.plane_count;
  if (!behind || !beyond || *behind == *beyond ||
      std::find(passed.begin(), first_unused, false) != first_unused)
    return false;
  constexpr std::int64_t kMax = std::numeric_limits<std::int8_t>::max();
  if (std::max({*behind, *beyond, -*behind, -*beyond}) > kMax) return false;
  cell.behind = static_cast<int>(*behind);
  cell.beyond = static_cast<int>(*beyond);
  return true;
}

}  // namespace

bool in_few_planes(std::span<const Triangle> triangles) { return Planes().add_all(triangles); }

std::optional<SpecialCell> special_cell(std::span<const Triangle> triangles,
                                        const std::array<Point, 8>& corners,
                                        const std::array<std::int64_t, 8>& winding) {
  Planes planes;
  if (!planes.add_all(triangles) || !planes.enclose(triangles) ||
      !settle(planes.cell(), corners, winding))
    return std::nullopt;
  return planes.cell();
}

bool is_special_cell(const SpecialCell& claim, std::span<const Triangle> triangles,
                     const std::array<Point, 8>& corners,
                     const std::array<std::int64_t, 8>& winding) {
  const auto lies_in_one = [&](const Triangle& triangle) {
    bool in_one = false;
    for (unsigned i = 0; i < claim.plane_count; ++i) {
      const Reach reach = reach_of(claim.planes[i], triangle);
      if (reach.beyond) return false;
      in_one = in_one || !reach.behind;
    }
    return in_one;
  };
  SpecialCell settled = claim;
  return std::all_of(triangles.begin(), triangles.end(), lies_in_one) &&
         settle(settled, corners, winding) && settled.behind == claim.behind &&
         settled.beyond == claim.beyond;
}

}  // namespace planetree::octree
