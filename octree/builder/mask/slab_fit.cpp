#include "octree/builder/mask/slab_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// In 256ths of the width, each of which is at least 2^-3: far more than the errors of heights,
/// which are below 2^-40.
constexpr double kSlabFitSlack = 0x1p-6;

/// The direction nearest to a normal; the same for the opposite normal.
std::uint16_t direction_of(const Point& normal) {
  Eigen::Index a;
  normal.cwiseAbs().maxCoeff(&a);
  const auto slope = [&](Eigen::Index axis) {
    return static_cast<int>(std::floor(CellSlab::kSteps * (normal[axis] / normal[a]) + 0.5));
  };
  return CellSlab::make_direction(static_cast<unsigned>(a), slope((a + 1) % 3), slope((a + 2) % 3));
}

}  // namespace

CellSlab fit_slab(const GridCell& cell, const Point& lower,
                  const std::vector<BoxedTriangle>& triangles,
                  const std::vector<std::uint32_t>& positions) {
  Point normals = Point::Zero();
  for (const std::uint32_t position : positions) {
    const auto& [a, b, c] = triangles[position].corners;
    normals += static_cast<double>(triangles[position].copies) * (b - a).cross(c - a);
  }
  CellSlab slab;
  if (!(normals.squaredNorm() > 0) || !normals.allFinite()) return slab;
  slab.direction = direction_of(normals);
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (const std::uint32_t position : positions)
    for (const Point& corner : triangles[position].corners) {
      const double height = slab.height(CellSlab::position_in(corner, lower, cell.level));
      least = std::min(least, height);
      greatest = std::max(greatest, height);
    }
  const double steps = 256.0 / slab.width();
  const auto in_byte = [](double step) {
    return static_cast<std::uint8_t>(std::clamp(step, 0.0, 255.0));
  };
  slab.lower = in_byte(std::floor(least * steps - 0.5 - kSlabFitSlack));
  slab.upper = in_byte(std::ceil(greatest * steps - 0.5 + kSlabFitSlack));
  if (!slab.has_plane()) return {};
  return slab;
}

}  // namespace planetree::octree
