#include "tools/check/moment_check.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/wide_numbers.h"
#include "octree/page/moments.h"
#include "octree/traversal/bounds.h"
#include "tools/check/frame_view.h"

namespace planetree::tools {
namespace {

using octree::Point;
using Matrix = Eigen::Matrix3d;

/// Expected moments and their allowed errors.
struct Expected {
  Point vector = Point::Zero();   ///< dipole
  Matrix first = Matrix::Zero();  ///< quadrupole, before it is made symmetric and trace-free
  double area = 0, second = 0;    ///< lower limits of area and second moment
  double vector_error = 0, first_error = 0;
};

Point vector_of(const octree::Moments& moments) {
  return Point(moments.vector[0], moments.vector[1], moments.vector[2]) * moments.dipole_unit();
}

Matrix first_of(const octree::Moments& moments) {
  const auto& [xx, yy, xy, yz, zx] = moments.first;
  Matrix first;
  first << xx, xy, zx, xy, yy, yz, zx, yz, -xx - yy;
  return first * moments.quadrupole_unit();
}

/// Whether stated moments fit. The added share kRelativeSlack is far above the rounding of doubles
/// and of points relative to the centre.
bool fits(const octree::Moments& stated, const Expected& expected) {
  constexpr double kRelativeSlack = 0x1p-30;
  if (!stated.are_known()) return true;
  const double area = octree::Moments::wide(stated.area);
  const double second = octree::Moments::wide(stated.second);
  const double extent = std::sqrt(second / area);
  const double position_error = octree::kAbsoluteBoundSlack * area;
  if (area * (1 + kRelativeSlack) < expected.area) return false;
  if (second * (1 + kRelativeSlack) + position_error * (extent + octree::kAbsoluteBoundSlack) <
      expected.second)
    return false;
  const double vector_error =
      (octree::kDipoleError + kRelativeSlack) * area + expected.vector_error;
  if (!((vector_of(stated) - expected.vector).norm() <= vector_error)) return false;
  const Matrix symmetric = (expected.first + expected.first.transpose()) / 2 -
                           expected.first.trace() / 3 * Matrix::Identity();
  const double first_error = octree::kQuadrupoleError * stated.quadrupole_unit() +
                             kRelativeSlack * area * extent + position_error + expected.first_error;
  return (first_of(stated) - symmetric).norm() <= first_error;
}

}  // namespace

bool moments_fit(const Bounds& stated, const octree::BlockView& block, const Point& centre) {
  const Point middle = octree::centre_of(stated.box);
  Expected expected;
  for (unsigned i = 0; i < block.triangle_count(); ++i) {
    octree::Triangle e = block.triangle(i);
    for (Point& corner : e) corner = (corner - centre) - middle;
    const auto twice = octree::cross(octree::difference<double>(e[1], e[0]),
                                     octree::difference<double>(e[2], e[0]));
    const Point vector = 0.5 * Point(twice[0], twice[1], twice[2]);
    const Point sum = e[0] + e[1] + e[2];
    const double area = vector.norm();
    expected.vector += vector;
    expected.first += sum / 3 * vector.transpose();
    expected.area += area;
    expected.second +=
        area / 12 *
        (e[0].squaredNorm() + e[1].squaredNorm() + e[2].squaredNorm() + sum.squaredNorm());
  }
  return fits(stated.moments, expected);
}

bool moments_fit(const Bounds& stated, const octree::Node& node) {
  // Stored areas and second moments may be larger by 1/128 and a little.
  constexpr double kKept = 1 - 1.01 / 128;
  const Point middle = octree::centre_of(stated.box);
  Expected expected;
  for (unsigned i = 0; i < node.child_count; ++i) {
    const octree::Moments moments = octree::NodeMoments::of(node).child(i);
    const Point by = octree::centre_of(child_box(node, i)) - middle;
    const Point vector = vector_of(moments);
    const double area = octree::Moments::wide(moments.area);
    const double second = octree::Moments::wide(moments.second);
    // A writer may have rounded an area this small up from almost 0.
    const double least = 2 * octree::Moments::wide(octree::kMinShortFloat);
    const double kept = area > least ? area * kKept : 0;
    expected.vector += vector;
    expected.vector_error += octree::kDipoleError * area;
    expected.first += first_of(moments) + by * vector.transpose();
    expected.first_error += octree::kQuadrupoleError * moments.quadrupole_unit() +
                            by.norm() * octree::kDipoleError * area;
    expected.area += kept;
    // Minkowski's inequality: about `middle`, the second moment of a child is at least
    // max(0, |by| sqrt(area) - sqrt(second))^2.
    const double apart = std::max(0.0, by.norm() * std::sqrt(kept) - std::sqrt(second));
    expected.second += apart * apart;
  }
  return fits(stated.moments, expected);
}

}  // namespace planetree::tools
