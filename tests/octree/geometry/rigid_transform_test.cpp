#include "octree/geometry/rigid_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

using Real = boost::multiprecision::cpp_bin_float_100;

struct RealVector {
  Real x, y, z;
};
struct RealQuaternion {
  Real w, x, y, z;
};

RealQuaternion real(const Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

RealQuaternion divided_by_length(const RealQuaternion& q) {
  const Real length = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w / length, q.x / length, q.y / length, q.z / length};
}

// q p q*, which is |q|^2 times the rotation.
RealVector product(const RealQuaternion& q, const Vec3& p) {
  const Real w2 = q.w * q.w, x2 = q.x * q.x, y2 = q.y * q.y, z2 = q.z * q.z;
  const Real xy = 2 * q.x * q.y, xz = 2 * q.x * q.z, yz = 2 * q.y * q.z;
  const Real wx = 2 * q.w * q.x, wy = 2 * q.w * q.y, wz = 2 * q.w * q.z;
  return {(w2 + x2 - y2 - z2) * p.x + (xy - wz) * p.y + (xz + wy) * p.z,
          (xy + wz) * p.x + (w2 - x2 + y2 - z2) * p.y + (yz - wx) * p.z,
          (xz - wy) * p.x + (yz + wx) * p.y + (w2 - x2 - y2 + z2) * p.z};
}

// The usual matrix 1 - 2 (y^2 + z^2), ..., which is right for a quaternion of length 1.
RealVector by_matrix(const RealQuaternion& q, const Vec3& p) {
  const RealVector turned = product(q, p);
  const Real rest = 1 - (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {turned.x + rest * p.x, turned.y + rest * p.y, turned.z + rest * p.z};
}

double error_of(const Vec3& computed, const RealVector& turned, const RealVector& translation) {
  const Real x = computed.x - turned.x - translation.x, y = computed.y - turned.y - translation.y,
             z = computed.z - turned.z - translation.z;
  return sqrt(x * x + y * y + z * z).convert_to<double>();
}

// Of any size.
Vec3 random_vector(Noise& noise) {
  const double size = std::ldexp(1, static_cast<int>(noise.uniform(-40, 40)));
  return noise.point(-size, size);
}

double length(const Vec3& p) { return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z); }

class RigidTransformTest : public testing::Test {
 protected:
  // A quaternion of length 1 that is no double.
  RealQuaternion random_rotation() {
    const Vec3 v = noise_.point(-1, 1);
    return divided_by_length({sign(), v.x, v.y, v.z});
  }
  double sign() { return noise_.uniform(-1, 1); }
  // Compares with the true position. Keeps the greatest error as a share of its bound.
  void expect_bound(const RigidTransform& transform, const Vec3& p, const RealVector& turned,
                    const RealVector& translation) {
    const double bound = transform.position_error(length(p));
    const double error = error_of(transform.apply(p), turned, translation);
    EXPECT_LE(error, bound);
    greatest_ = std::max(greatest_, error / bound);
    EXPECT_LE(error_of(transform.rotate(p), turned, {}),
              transform.rotation_error() * length(p) + kUnresolvedLength);
  }

  Noise noise_{1};
  double greatest_ = 0;
};

TEST_F(RigidTransformTest, BoundsTheErrorOfAPoseThatWasRounded) {
  for (int i = 0; i < 2000; ++i) {
    const RealQuaternion q = random_rotation();
    const Vec3 p = random_vector(noise_), t = random_vector(noise_);
    // Half of the last bit more than a double has.
    const Real half = Real(sign()) * 0x1p-53;
    const RealVector translation{t.x * (1 + half), t.y * (1 - half), t.z * (1 + half)};
    const Pose pose{{q.w.convert_to<double>(), q.x.convert_to<double>(), q.y.convert_to<double>(),
                     q.z.convert_to<double>()},
                    t};
    const auto transform = RigidTransform::of(pose);
    ASSERT_TRUE(transform);
    expect_bound(*transform, p, product(q, p), translation);
  }
  EXPECT_GT(greatest_, 0.02);
}

TEST_F(RigidTransformTest, BoundsTheErrorOfAQuaternionThatIsNotOfLengthOne) {
  for (int i = 0; i < 2000; ++i) {
    const RealQuaternion q = random_rotation();
    const Real factor = 1 + Real(sign()) * std::ldexp(1, -22 - i % 40);
    const Quaternion off{(q.w * factor).convert_to<double>(), (q.x * factor).convert_to<double>(),
                         (q.y * factor).convert_to<double>(), (q.z * factor).convert_to<double>()};
    const Vec3 p = random_vector(noise_), t = random_vector(noise_);
    const auto transform = RigidTransform::of({off, t});
    ASSERT_TRUE(transform);
    const RealVector translation{t.x, t.y, t.z};
    expect_bound(*transform, p, product(divided_by_length(real(off)), p), translation);
    expect_bound(*transform, p, product(real(off), p), translation);
    expect_bound(*transform, p, by_matrix(real(off), p), translation);
  }
  EXPECT_GT(greatest_, 0.4);
}

TEST_F(RigidTransformTest, KeepsTheBitsOfThePoseThatDoesNothing) {
  const auto transform = RigidTransform::of({});
  ASSERT_TRUE(transform);
  const Vec3 same = transform->apply({0.1, -2e9, 3e-300});
  EXPECT_EQ(same.x, 0.1);
  EXPECT_EQ(same.y, -2e9);
  EXPECT_EQ(same.z, 3e-300);
}

TEST_F(RigidTransformTest, RefusesPosesThatAreNotValid) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(RigidTransform::of({{kNan, 0, 0, 0}, {}}));
  EXPECT_FALSE(RigidTransform::of({{1, 0, 0, kNan}, {}}));
  EXPECT_FALSE(RigidTransform::of({{1e300, 0, 0, 0}, {}}));
  EXPECT_FALSE(RigidTransform::of({{0, 0, 0, 0}, {}}));
  EXPECT_FALSE(RigidTransform::of({{1 + 0x1p-20, 0, 0, 0}, {}}));
  EXPECT_TRUE(RigidTransform::of({{1 + 0x1p-22, 0, 0, 0}, {}}));
  for (const double bad : {kNan, -kNan, 0x1p501, -0x1p501}) {
    EXPECT_FALSE(RigidTransform::of({{}, {bad, 0, 0}}));
    EXPECT_FALSE(RigidTransform::of({{}, {0, bad, 0}}));
    EXPECT_FALSE(RigidTransform::of({{}, {0, 0, bad}}));
  }
  EXPECT_TRUE(RigidTransform::of({{}, {0x1p500, 0, -0x1p500}}));
}

}  // namespace
}  // namespace planetree::octree
