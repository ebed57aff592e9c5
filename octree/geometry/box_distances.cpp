#include "octree/geometry/box_distances.h"

#include <Eigen/Core>
#include <limits>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

using Numbers = Eigen::Map<const Eigen::ArrayXd>;

Numbers first(std::span<const double> values, std::size_t count) {
  return {values.data(), static_cast<Eigen::Index>(count)};
}

}  // namespace

void squared_box_distances(const BoxColumns& boxes, const Vec3& point, std::span<double> squared) {
  const std::size_t count = squared.size();
  const auto gap = [&](std::size_t axis, double at) {
    return (first(boxes[axis], count) - at).max(at - first(boxes[axis + 3], count)).max(0.0);
  };
  Eigen::Map<Eigen::ArrayXd>(squared.data(), static_cast<Eigen::Index>(count)) =
      (gap(0, point.x).square() + gap(1, point.y).square() + gap(2, point.z).square())
          .min(std::numeric_limits<double>::max());
}

double least_value(std::span<const double> values) {
  if (values.empty()) return std::numeric_limits<double>::infinity();
  return first(values, values.size()).minCoeff();
}

}  // namespace planetree::octree
