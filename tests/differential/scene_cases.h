#pragma once

#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "planetree/scene.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/queries/wrench_oracle.h"
#include "tests/oracle/random.h"

/// Scenes of random models in random places, and where they are, with 113 bits.
namespace planetree::oracle {

using Real = boost::multiprecision::cpp_bin_float_quad;
using RealPoint = std::array<Real, 3>;

inline RealPoint real(const Vec3& v) { return {Real(v.x), Real(v.y), Real(v.z)}; }

inline RealPoint cross(const RealPoint& a, const RealPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// A rotation, by the unit quaternion w + u.
struct Rotation {
  RealPoint u;
  Real w;

  Rotation inverse() const { return {{-u[0], -u[1], -u[2]}, w}; }
  // v + 2 w (u x v) + 2 u x (u x v)
  RealPoint of(const RealPoint& v) const {
    const RealPoint once = cross(u, v), twice = cross(u, once);
    RealPoint sum;
    for (std::size_t i = 0; i < 3; ++i) sum[i] = v[i] + 2 * w * once[i] + 2 * twice[i];
    return sum;
  }
};

inline Rotation rotation(const Quaternion& q) {
  const Real x = q.x, y = q.y, z = q.z, w = q.w;
  const Real length = sqrt(x * x + y * y + z * z + w * w);
  return {{x / length, y / length, z / length}, w / length};
}

// The rotation b, and a after it.
inline Rotation joined(const Rotation& a, const Rotation& b) {
  const RealPoint both = cross(a.u, b.u);
  Rotation product;
  for (std::size_t i = 0; i < 3; ++i) product.u[i] = a.w * b.u[i] + b.w * a.u[i] + both[i];
  product.w = a.w * b.w - a.u[0] * b.u[0] - a.u[1] * b.u[1] - a.u[2] * b.u[2];
  return product;
}

// A point in the frame of an instance: the nearest doubles, and how far they are off.
struct Local {
  Vec3 point;
  Real slack;
};

inline Local rounded(const RealPoint& exact) {
  const Vec3 point{double(exact[0]), double(exact[1]), double(exact[2])};
  Real slack = 0;
  for (std::size_t i = 0; i < 3; ++i) slack += abs(exact[i] - real(point)[i]);
  return {point, slack};
}

inline Local to_local(const Pose& pose, const Vec3& world) {
  const RealPoint from = real(world), t = real(pose.translation);
  return rounded(
      rotation(pose.rotation).inverse().of({from[0] - t[0], from[1] - t[1], from[2] - t[2]}));
}

inline Vec3 to_world(const Pose& pose, const Vec3& local) {
  const RealPoint at = rotation(pose.rotation).of(real(local));
  return {double(at[0] + pose.translation.x), double(at[1] + pose.translation.y),
          double(at[2] + pose.translation.z)};
}

struct Placed {
  const BuiltModel* model;
  Pose pose;
  InstanceId id;
};

inline Pose random_pose(Random& random) {
  if (random.one_in(6)) return {};
  Pose pose{random_rotation(random), random.in_cube() * random.magnitude(-3, 3)};
  if (random.one_in(4)) pose.rotation = {};
  if (random.one_in(8)) pose.translation = random.in_cube() * 1e6;
  return pose;
}

/// A scene of some models in some places, with a probe.
class SceneCase {
 public:
  SceneCase(Random& random, std::span<const NastyFamily> families)
      : scene_(std::move(*Scene::create(options(random)))),
        probe_(std::move(*SceneProbe::create(scene_))) {
    for (std::size_t i = 2 + random.below(4); i > 0; --i)
      models_.push_back(std::make_unique<BuiltModel>(
          families[random.below(families.size())].make(random), BuildChoices{4096}));
    for (std::size_t i = 2 + random.below(8); i > 0; --i) {
      const BuiltModel& model = *models_[random.below(models_.size())];
      const Pose pose = random_pose(random);
      const auto id = scene_.add(model.path(), pose);
      EXPECT_TRUE(id) << id.error().text;
      if (id) placed_.push_back({&model, pose, *id});
    }
  }
  void move_some(Random& random) {
    for (Placed& each : placed_) {
      if (!random.one_in(3)) continue;
      each.pose = random_pose(random);
      EXPECT_TRUE(scene_.set_pose(each.id, each.pose));
    }
  }
  // Gives each instance a twist, and returns them.
  std::vector<Twist> twist_all(Random& random) {
    std::vector<Twist> twists;
    for (const Placed& each : placed_) {
      Twist twist{random.in_cube() * 2, random.in_cube() * 0.5};
      if (random.one_in(3)) twist = {};
      EXPECT_TRUE(scene_.set_pose(each.id, each.pose, twist));
      twists.push_back(twist);
    }
    return twists;
  }
  // A point that is critical for one of the instances.
  Vec3 query(Random& random) const {
    const Placed& each = placed_[random.below(placed_.size())];
    return to_world(each.pose, nasty_query(random, each.model->triangles(), 1));
  }
  bool is_moderate(const Vec3& v) const {
    return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z) < 1e60;
  }
  const std::vector<Placed>& placed() const { return placed_; }
  SceneProbe& probe() { return probe_; }

 private:
  static SceneOptions options(Random& random) {
    SceneOptions options;
    options.memory_budget_bytes = std::uint64_t{random.one_in(2) ? 4U : 32U} << 20;
    options.max_probes = 1;
    options.max_page_bytes = 4096;
    options.locking = Locking::kNever;
    return options;
  }

  std::vector<std::unique_ptr<BuiltModel>> models_;
  Scene scene_;
  SceneProbe probe_;
  std::vector<Placed> placed_;
};

}  // namespace planetree::oracle
