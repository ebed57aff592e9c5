#include "octree/builder/openness.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {

std::int64_t Openness::whole(double area) {
  return static_cast<std::int64_t>(std::clamp(area, -kMaxArea, kMaxArea) / kUnit);
}

void Openness::Sums::add(const Triangle& triangle) {
  const Point u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
  double square = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Index i = (axis + 1) % 3, j = (axis + 2) % 3;
    const double component = 0.5 * (u[i] * v[j] - u[j] * v[i]);
    vector[axis] += whole(component);
    square += component * component;
  }
  area += whole(std::sqrt(square));
}

void Openness::Sums::add(const Sums& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) vector[axis] += other.vector[axis];
  area += other.area;
}

void Openness::add(const Triangles& part) {
  Sums sums;
  for (std::uint32_t i = 0; i < part.size(); ++i) sums.add(part.corners(i));
  const std::lock_guard lock(mutex_);
  sums_.add(sums);
}

double Openness::value() const {
  const std::lock_guard lock(mutex_);
  if (sums_.area == 0) return 0;
  const auto area = static_cast<double>(sums_.area);
  double square = 0;
  for (const Int128 component : sums_.vector) {
    const double share = static_cast<double>(component) / area;
    square += share * share;
  }
  return std::min(std::sqrt(square), 1.0);
}

}  // namespace planetree::octree
