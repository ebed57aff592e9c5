#include "octree/builder/mesh/stream/polygon_triangulator.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "octree/builder/mesh/stream/polygon_projection.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Larger coordinates are scaled down, so that no product overflows. What is lost is smaller than
/// the largest coordinate by a factor of 2^450.
constexpr double kMaxCoordinate = 0x1p200;
constexpr double kScaleDown = 0x1p-824;
/// Distance from the plane that passes for rounding, as a share of the largest coordinate: a few
/// units in the sixth decimal.
constexpr double kPlanarTolerance = 0x1p-18;

double largest_coordinate(std::span<const Vec3> corners) {
  double largest = 0;
  for (const Vec3& p : corners)
    largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  return largest;
}

Vec3 difference(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// Twice the area vector, rounded: the sum over the fan about corner 0.
Vec3 area_vector(std::span<const Vec3> corners) {
  Vec3 sum;
  Vec3 a = difference(corners[1], corners[0]);
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const Vec3 b = difference(corners[k], corners[0]);
    sum.x += a.y * b.z - a.z * b.y;
    sum.y += a.z * b.x - a.x * b.z;
    sum.z += a.x * b.y - a.y * b.x;
    a = b;
  }
  return sum;
}

/// The axis of the largest component; of equal ones the first.
unsigned dominant_axis(const Vec3& normal) {
  const double x = std::fabs(normal.x), y = std::fabs(normal.y), z = std::fabs(normal.z);
  if (x >= y && x >= z) return 0;
  return y >= z ? 1 : 2;
}

/// Sums up by how many quarters of a circle the edges of a polygon turn. A spike turns by a half
/// either way.
class QuarterTurns {
 public:
  explicit QuarterTurns(const PolygonProjection& polygon) : polygon_(polygon) {
    std::size_t from = polygon.size() - 1;
    std::size_t before = from;
    while (before > 0 && polygon.is_same(before, 0)) --before;
    from = before;  // the edge from here to corner 0, or to one equal to it, has a length
    std::size_t at = 0;
    for (std::size_t k = 1; k <= polygon.size(); ++k) {
      const std::size_t next = k == polygon.size() ? 0 : k;
      if (polygon.is_same(at, next)) continue;
      add(from, at, next);
      from = at;
      at = next;
    }
  }
  /// Whether the edges may turn by one circle, as those of a simple polygon do.
  ///
  /// side  1 or -1: the way it runs.
  [[nodiscard]] bool may_be_simple(int side) const {
    return std::abs(sum_ - 4 * side) <= 2 * spikes_;
  }

 private:
  // Quarter of the circle that an edge points into; each contains the axis it begins with.
  [[nodiscard]] int quarter(std::size_t from, std::size_t to) const {
    const bool right = polygon_.u(to) > polygon_.u(from), left = polygon_.u(to) < polygon_.u(from);
    const bool up = polygon_.v(to) > polygon_.v(from), down = polygon_.v(to) < polygon_.v(from);
    if (right && !down) return 0;
    if (up) return 1;
    return left ? 2 : 3;
  }
  void add(std::size_t from, std::size_t at, std::size_t to) {
    const int quarters = (quarter(at, to) - quarter(from, at) + 4) % 4;
    if (quarters != 2) {
      sum_ += quarters == 3 ? -1 : quarters;
      return;
    }
    const int turn = polygon_.turn(from, at, to);
    sum_ += 2 * turn;
    spikes_ += turn == 0 ? 1 : 0;
  }

  const PolygonProjection& polygon_;
  std::int64_t sum_ = 0;
  std::int64_t spikes_ = 0;
};

enum class Fan : std::uint8_t { kValid, kInvalid, kNoArea };

/// Examines the fan about corner 0: whether all its triangles turn the same way and go at most once
/// around corner 0. kNoArea if none of them has an area as seen along the axis.
Fan fan_of(const PolygonProjection& polygon) {
  int side = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const int turn = polygon.turn(0, k - 1, k);
    if (turn == 0) continue;
    if (side == -turn) return Fan::kInvalid;
    side = turn;
  }
  if (side == 0) return Fan::kNoArea;
  // Each triangle turns by less than half a circle: two of them never go around.
  if (polygon.size() == 4) return Fan::kValid;
  std::size_t first = 1;  // the first corner that is elsewhere than corner 0
  while (polygon.is_same(0, first)) ++first;
  bool beyond_half = false, at_first = false, returns = false;
  for (std::size_t k = first + 1; k < polygon.size(); ++k) {
    const int turn = side * polygon.turn(0, first, k);
    if (turn > 0 && beyond_half) return Fan::kInvalid;
    beyond_half |= turn < 0;
    const bool was_at_first = at_first;
    at_first = turn == 0 && polygon.is_same(0, k);
    returns |= was_at_first && !at_first;
  }
  // Where the outline comes back to corner 0 and goes on, its parts may lie on each other.
  return !returns || QuarterTurns(polygon).may_be_simple(side) ? Fan::kValid : Fan::kInvalid;
}

bool is_planar(std::span<const Vec3> corners, const Vec3& normal) {
  const double length = std::max({std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)});
  const double tolerance = kPlanarTolerance * largest_coordinate(corners) * length;
  return std::ranges::all_of(corners, [&](const Vec3& corner) {
    const Vec3 d = difference(corner, corners[0]);
    return std::fabs(normal.x * d.x + normal.y * d.y + normal.z * d.z) <= tolerance;
  });
}

}  // namespace

PolygonFault PolygonTriangulator::split(std::span<const Vec3> corners) {
  triangles_.clear();
  if (largest_coordinate(corners) <= kMaxCoordinate) return split_scaled(corners);
  scaled_.clear();
  for (const Vec3& p : corners)
    scaled_.push_back({p.x * kScaleDown, p.y * kScaleDown, p.z * kScaleDown});
  return split_scaled(scaled_);
}

PolygonFault PolygonTriangulator::split_scaled(std::span<const Vec3> corners) {
  const Vec3 normal = area_vector(corners);
  const unsigned axis = dominant_axis(normal);
  // Seen along another axis if rounding alone gave this one.
  for (unsigned other = 0; other < 3; ++other) {
    PolygonProjection polygon(corners, (axis + other) % 3);
    const Fan fan = fan_of(polygon);
    if (fan == Fan::kValid) return PolygonFault::kNone;
    if (fan == Fan::kInvalid) return cut_ears(corners, polygon, normal);
  }
  return PolygonFault::kNone;  // on one line
}

PolygonFault PolygonTriangulator::cut_ears(std::span<const Vec3> corners,
                                           PolygonProjection& polygon, const Vec3& normal) {
  const int side = polygon_area_sign(corners, polygon.axis());
  const bool may_be_simple = side == 0 || QuarterTurns(polygon).may_be_simple(side);
  if (side < 0) polygon.turn_over();
  if (!may_be_simple || !ears_.clip(polygon, side != 0, triangles_)) {
    triangles_.clear();
    return may_be_simple && ears_.gave_up() ? PolygonFault::kTooLong : PolygonFault::kCrossing;
  }
  return is_planar(corners, normal) ? PolygonFault::kNone : PolygonFault::kNotPlanar;
}

}  // namespace planetree::octree
