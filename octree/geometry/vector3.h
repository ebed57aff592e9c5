#pragma once

#include <array>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "octree/geometry/triangle_distance.h"

/// Vectors of three numbers of any type: double, or wider where double loses too many bits. Eigen's
/// vectors hold only doubles in this project.
namespace planetree::octree {

/// Floating-point number with a mantissa of 113 bits.
using Quad = boost::multiprecision::cpp_bin_float_quad;

template <class Scalar>
using Vector3 = std::array<Scalar, 3>;

template <class Scalar>
Vector3<Scalar> cross(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class Scalar>
Scalar dot(const Vector3<Scalar>& a, const Vector3<Scalar>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Scalar>
Vector3<Scalar> difference(const Point& a, const Point& b) {
  return {Scalar(a.x()) - Scalar(b.x()), Scalar(a.y()) - Scalar(b.y()),
          Scalar(a.z()) - Scalar(b.z())};
}

}  // namespace planetree::octree
