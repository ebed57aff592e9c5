#include "octree/field/field_shape.h"

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

constexpr double kMarginShare = 0.125;  // of the longest edge
// Bytes of the field: half a byte a triangle, but up to 4 bytes a triangle for small models.
constexpr double kBytesPerTriangle = 0.5, kMaxBytesPerTriangle = 4;
constexpr double kSmallFieldBytes = 0x1p18;
// Steps and quanta have this many bits, so that their products with indices are exact.
constexpr int kStepBits = 24;

double rounded_up(double value) {
  int exponent = 0;
  const double share = std::frexp(value, &exponent);
  return std::ldexp(std::ceil(std::ldexp(share, kStepBits)), exponent - kStepBits);
}

std::uint64_t max_points(std::uint64_t triangles) {
  const auto count = static_cast<double>(triangles);
  const double bytes =
      std::max(kBytesPerTriangle * count, std::min(kSmallFieldBytes, kMaxBytesPerTriangle * count));
  return static_cast<std::uint64_t>(
      std::min(bytes / sizeof(FieldPoint), static_cast<double>(FieldShape::kMaxPoints)));
}

}  // namespace

FieldShape FieldShape::thinned(std::uint32_t n) const {
  FieldShape shape = *this;
  if (count() == 0) return shape;
  shape.step = step * n;
  for (std::uint32_t& along : shape.size) along = (along - 1) / n + 1;
  return shape;
}

std::uint32_t FieldShape::thinning_for(std::uint64_t max_bytes) const {
  const auto [least, greatest] = std::minmax_element(size.begin(), size.end());
  std::uint32_t n = 1;
  while (thinned(n).bytes() > max_bytes && 10 * (n + 1) < *greatest && n + 1 < *least) ++n;
  return n;
}

FieldShape FieldShape::of(const Point& core_lower, const Point& core_upper,
                          std::uint64_t triangles) {
  FieldShape shape;
  const double longest = (core_upper - core_lower).maxCoeff();
  if (triangles < kMinTriangles || !(longest > 0)) return shape;
  const double margin = kMarginShare * longest;
  const Point extent = core_upper - core_lower + Point::Constant(2 * margin);
  shape.lower = core_lower - Point::Constant(margin);
  const std::uint64_t most = max_points(triangles);
  // The most cells along the longest edge whose grid is not too large.
  for (std::uint32_t cells = 2;; ++cells) {
    FieldShape finer = shape;
    finer.step = rounded_up(extent.maxCoeff() / cells);
    for (unsigned axis = 0; axis < 3; ++axis)
      finer.size[axis] = static_cast<std::uint32_t>(std::ceil(extent[axis] / finer.step)) + 1;
    if (finer.count() > most) break;
    shape = finer;
  }
  if (shape.count() == 0) return {};
  const std::uint32_t points = *std::max_element(shape.size.begin(), shape.size.end());
  shape.quantum = rounded_up(shape.step * (points - 1) / kMaxFieldCoordinate);
  return shape;
}

}  // namespace planetree::octree
