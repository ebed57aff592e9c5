#include "octree/geometry/angle.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

constexpr double kHalfPi = 0x1.921fb54442d18p+0;

/// kArctangents[k] is the arctangent of k / 8.
constexpr std::array<double, 9> kArctangents = {
    0x0.0p+0,
    0x1.fd5ba9aac2f6ep-4,
    0x1.f5b75f92c80ddp-3,
    0x1.6f61941e4def1p-2,
    0x1.dac670561bb4fp-2,
    0x1.1e00babdefeb4p-1,
    0x1.4978fa3269ee1p-1,
    0x1.700a7c5784634p-1,
    0x1.921fb54442d18p-1,
};

/// Returns the arctangent of t, 0 <= t <= 1. It is the arctangent of the nearest eighth c plus a
/// series for x = (t - c) / (1 + t c), which is at most 1/16. The first omitted term is below 2^-68
/// / 17.
double arctangent(double t) {
  const std::size_t eighth = (static_cast<std::size_t>(t * 16) + 1) / 2;
  const double c = static_cast<double>(eighth) / 8;
  const double x = (t - c) / (1 + t * c);
  const double x2 = x * x;
  double sum = 0;
  for (int power = 15; power >= 3; power -= 2) sum = x2 * (1.0 / power - sum);
  return kArctangents[eighth] + (x - x * sum);
}

}  // namespace

double angle_of(double along, double across) noexcept {
  const double ahead = std::fabs(along);
  const double acute =
      across <= ahead ? arctangent(across / ahead) : kHalfPi - arctangent(ahead / across);
  return along >= 0 ? acute : 2 * kHalfPi - acute;
}

double angle_between(const Point& u, const Point& v) noexcept {
  // Scaled to a length of about 1, so that no product overflows or underflows.
  const Point a = u / u.cwiseAbs().maxCoeff(), b = v / v.cwiseAbs().maxCoeff();
  return angle_of(a.dot(b), a.cross(b).norm());
}

}  // namespace planetree::octree
