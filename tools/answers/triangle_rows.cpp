#include "tools/answers/triangle_rows.h"

#include <algorithm>
#include <cmath>

namespace planetree::tools {

void TriangleRows::answer(std::span<const Vec3> points) {
  points_.clear();
  rows_.clear();
  for (const Vec3& point : points) answer(point);
}

void TriangleRows::answer(const Vec3& point) {
  if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.z))
    return add_without_triangle(point, Status::kBadQuery);
  constexpr std::size_t kFirst = 64;
  const bool is_cut_by_count = query_.nearest != TriangleRowsQuery::kNotGiven;
  const std::uint64_t most = is_cut_by_count ? query_.nearest : TriangleRowsQuery::kDefaultNearest;
  found_.resize(std::max<std::size_t>(found_.size(), std::min<std::uint64_t>(most, kFirst)));
  Found found;
  for (;;) {
    const auto room = std::span(found_).first(std::min<std::size_t>(found_.size(), most));
    found = find(point, room);
    if (found.complete || found.count < room.size() || room.size() == most) break;
    found_.resize(2 * room.size());
  }
  for (const ClosestPoint& answer : std::span(found_).first(found.count)) {
    points_.push_back(point);
    rows_.push_back(answer);
  }
  if (found.complete && found.count == 0)
    add_without_triangle(point, Status::kBeyondMaxDistance);
  else if (!found.complete && !(is_cut_by_count && found.count == most))
    add_without_triangle(point, Status::kDegraded);
}

Found TriangleRows::find(const Vec3& point, std::span<ClosestPoint> room) {
  return query_.wants_contacts() ? probe_.contacts(point, query_.contact_radius, room, options_)
                                 : probe_.triangles_within(point, query_.radius, room, options_);
}

void TriangleRows::add_without_triangle(const Vec3& point, Status status) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ClosestPoint none;
  none.distance = none.upper = kInfinity;
  if (status == Status::kBeyondMaxDistance)
    none.lower = std::min({query_.radius, query_.contact_radius, options_.max_distance});
  none.status = status;
  points_.push_back(point);
  rows_.push_back(none);
}

}  // namespace planetree::tools
