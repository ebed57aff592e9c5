#include "octree/geometry/area_sums.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {

std::int64_t AreaSums::whole(double area) {
  // Coordinates of a forged file may overflow to no number.
  if (!(std::fabs(area) <= kMaxArea)) area = area > 0 ? kMaxArea : -kMaxArea;
  return static_cast<std::int64_t>(area / kUnit);
}

bool AreaSums::is_in_core(const Triangle& triangle) const {
  return (least_corner(triangle).array() >= lower_.array()).all() &&
         (greatest_corner(triangle).array() <= upper_.array()).all();
}

void AreaSums::add(const Triangle& triangle) {
  if (!is_in_core(triangle)) return;
  const Point u = triangle[1] - triangle[0], v = triangle[2] - triangle[0];
  double square = 0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Eigen::Index i = (axis + 1) % 3, j = (axis + 2) % 3;
    const double component = 0.5 * (u[i] * v[j] - u[j] * v[i]);
    vector_[axis] += whole(component);
    square += component * component;
  }
  area_ += whole(std::sqrt(square));
}

void AreaSums::add(const AreaSums& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) vector_[axis] += other.vector_[axis];
  area_ += other.area_;
}

AreaSums::Words AreaSums::words() const {
  Words words{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto sum = static_cast<Word128>(i < 3 ? vector_[i] : area_);
    words[2 * i] = static_cast<std::uint64_t>(sum);
    words[2 * i + 1] = static_cast<std::uint64_t>(sum >> 64);
  }
  return words;
}

void AreaSums::add(const Words& words) {
  for (std::size_t i = 0; i < 4; ++i) {
    Int128& sum = i < 3 ? vector_[i] : area_;
    const Word128 added = Word128{words[2 * i + 1]} << 64 | words[2 * i];
    sum = static_cast<Int128>(static_cast<Word128>(sum) + added);
  }
}

double AreaSums::openness() const {
  if (area_ == 0) return 0;
  const auto area = static_cast<double>(area_);
  double square = 0;
  for (const Int128 component : vector_) {
    const double share = static_cast<double>(component) / area;
    square += share * share;
  }
  return std::min(std::sqrt(square), 1.0);
}

}  // namespace planetree::octree
