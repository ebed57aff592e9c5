#pragma once

#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "planetree/types.h"

/// Vectors of three doubles.
namespace planetree::query {

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(const Vec3& a, double factor) {
  return {a.x * factor, a.y * factor, a.z * factor};
}
inline double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline bool is_finite(const Vec3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}
/// The length of a vector whose components are rounded sums of two numbers, or more.
inline double upper_length(const Vec3& a) {
  return std::sqrt(dot(a, a)) * (1 + octree::kNormRounding) + octree::kUnresolvedLength;
}

}  // namespace planetree::query
