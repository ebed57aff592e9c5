// Scenes against all triangles of all their instances, exactly, in random places.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "planetree/scene.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/queries/wrench_oracle.h"
#include "tests/oracle/random.h"
#include "tests/oracle/winding.h"

namespace planetree::oracle {
namespace {

using Real = boost::multiprecision::cpp_bin_float_quad;
using RealPoint = std::array<Real, 3>;

RealPoint real(const Vec3& v) { return {Real(v.x), Real(v.y), Real(v.z)}; }

RealPoint cross(const RealPoint& a, const RealPoint& b) {
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

Rotation rotation(const Quaternion& q) {
  const Real x = q.x, y = q.y, z = q.z, w = q.w;
  const Real length = sqrt(x * x + y * y + z * z + w * w);
  return {{x / length, y / length, z / length}, w / length};
}

// The rotation b, and a after it.
Rotation joined(const Rotation& a, const Rotation& b) {
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

Local rounded(const RealPoint& exact) {
  const Vec3 point{double(exact[0]), double(exact[1]), double(exact[2])};
  Real slack = 0;
  for (std::size_t i = 0; i < 3; ++i) slack += abs(exact[i] - real(point)[i]);
  return {point, slack};
}

Local to_local(const Pose& pose, const Vec3& world) {
  const RealPoint from = real(world), t = real(pose.translation);
  return rounded(
      rotation(pose.rotation).inverse().of({from[0] - t[0], from[1] - t[1], from[2] - t[2]}));
}

Vec3 to_world(const Pose& pose, const Vec3& local) {
  const RealPoint at = rotation(pose.rotation).of(real(local));
  return {double(at[0] + pose.translation.x), double(at[1] + pose.translation.y),
          double(at[2] + pose.translation.z)};
}

struct Placed {
  const BuiltModel* model;
  Pose pose;
  InstanceId id;
};

Pose random_pose(Random& random) {
  if (random.one_in(6)) return {};
  Pose pose{random_rotation(random), random.in_cube() * random.magnitude(-3, 3)};
  if (random.one_in(4)) pose.rotation = {};
  if (random.one_in(8)) pose.translation = random.in_cube() * 1e6;
  return pose;
}

// What is true of a point and a scene.
struct Truth {
  Real distance = std::numeric_limits<double>::infinity();  // to the nearest instance
  Real slack = 0;                                           // of that
  bool is_inside = false, is_outside = true;                // both false: not certain
};

Truth truth_of(const std::vector<Placed>& placed, const Vec3& query, bool has_sides) {
  Truth truth;
  for (const Placed& each : placed) {
    const Local local = to_local(each.pose, query);
    const Real distance(exact_distance(local.point, each.model->triangles()));
    truth.slack = std::max<Real>(truth.slack, local.slack);
    truth.distance = std::min<Real>(truth.distance, distance);
    if (!has_sides) continue;
    const Side side = exact_side(local.point, each.model->triangles());
    const bool is_certain = distance > local.slack;
    if (side == Side::kInside && is_certain) truth.is_inside = true;
    if (side == Side::kInside || !is_certain) truth.is_outside = false;
  }
  return truth;
}

void expect_holds(const Truth& truth, const SceneClosestPoint& answer) {
  EXPECT_LE(Real(answer.lower), truth.distance + truth.slack);
  EXPECT_GE(Real(answer.upper), truth.distance - truth.slack);
  EXPECT_LT(answer.lower, answer.upper);
}

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

// Where a moving instance is at a time of its motion, with sines of 113 bits.
struct RealPose {
  Rotation rotation;
  RealPoint translation;
};

RealPose real_pose(const Pose& pose, const Twist& twist, double seconds, const Real& time) {
  const RealPoint turn{twist.angular.x * (seconds * time), twist.angular.y * (seconds * time),
                       twist.angular.z * (seconds * time)};
  const Real angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
  const Real half = angle / 2, share = angle == 0 ? Real(0.5) : Real(sin(half) / angle);
  const Rotation since{{turn[0] * share, turn[1] * share, turn[2] * share}, cos(half)};
  const auto at = [&](double from, double speed) -> Real { return from + speed * seconds * time; };
  return {joined(since, rotation(pose.rotation)),
          {at(pose.translation.x, twist.linear.x), at(pose.translation.y, twist.linear.y),
           at(pose.translation.z, twist.linear.z)}};
}

// The centre of a moving ball in the frame of an instance, and its distance with its slack.
struct Centre {
  RealPoint at;
  Real distance, slack;
};
Centre centre_at(const Placed& placed, const Twist& twist, double seconds, const Sweep& sweep,
                 const Real& time) {
  const RealPose pose = real_pose(placed.pose, twist, seconds, time);
  const RealPoint from = real(sweep.from), to = real(sweep.to);
  RealPoint d;
  for (std::size_t i = 0; i < 3; ++i)
    d[i] = from[i] + (to[i] - from[i]) * time - pose.translation[i];
  const RealPoint exact = pose.rotation.inverse().of(d);
  const Local local = rounded(exact);
  return {exact, Real(exact_distance(local.point, placed.model->triangles())), local.slack};
}

void check_sweeps(std::span<const NastyFamily> families, std::size_t seed) {
  Random random(seed);
  std::size_t touched = 0, certain = 0, free = 0;
  for (int i = 0; i < 8 * test_effort(); ++i) {
    SceneCase scene(random, families);
    for (int k = 0; k < 25 && !testing::Test::HasFailure(); ++k) {
      SCOPED_TRACE(testing::Message() << "scene " << i << " sweep " << k);
      scene.move_some(random);
      const double seconds = random.one_in(3) ? 0 : random.magnitude(-10, 0);
      const std::vector<Twist> twists = scene.twist_all(random);
      const Sweep sweep{scene.query(random), scene.query(random),
                        random.one_in(4) ? 0 : random.magnitude(-20, 0)};
      if (!scene.is_moderate(sweep.from) || !scene.is_moderate(sweep.to)) continue;
      const SceneFirstContact contact = scene.probe().first_contact(sweep, seconds);
      EXPECT_EQ(contact.free, contact.t_lower > 1 && contact.status == Status::kExact);
      Real nearest = std::numeric_limits<double>::infinity();
      for (std::size_t n = 0; n < scene.placed().size(); ++n) {
        for (int step = 0; step <= 6; ++step) {
          if (contact.t_lower == 0) break;
          const Real time = std::min(1.0, 0.999999 * contact.t_lower) * Real(step) / 6;
          const Centre centre = centre_at(scene.placed()[n], twists[n], seconds, sweep, time);
          EXPECT_GE(centre.distance + centre.slack, Real(sweep.radius)) << step << " of " << n;
        }
        if (!(contact.t_upper <= 1)) continue;
        const Centre first =
            centre_at(scene.placed()[n], twists[n], seconds, sweep, contact.t_lower);
        const Centre last =
            centre_at(scene.placed()[n], twists[n], seconds, sweep, contact.t_upper);
        // A point may have passed through the surface in between.
        Real way = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) way += abs(last.at[axis] - first.at[axis]);
        nearest = std::min<Real>(nearest, last.distance - last.slack - way);
      }
      if (contact.t_upper <= 1) {
        EXPECT_LE(nearest, Real(sweep.radius)) << "no instance is touched in the end";
      }
      touched += contact.t <= 1;
      certain += contact.t_upper <= 1;
      free += contact.free;
    }
  }
  EXPECT_GT(touched, 20u);
  EXPECT_GT(certain, touched / 3);
  EXPECT_GT(free, 5u);
}

void check_queries(std::span<const NastyFamily> families, bool has_sides, std::size_t seed) {
  Random random(seed);
  std::size_t exact = 0, known = 0, total = 0;
  for (int i = 0; i < 6 * test_effort(); ++i) {
    SceneCase scene(random, families);
    for (int k = 0; k < 60 && !testing::Test::HasFailure(); ++k) {
      SCOPED_TRACE(testing::Message() << "scene " << i << " query " << k);
      scene.move_some(random);
      const Vec3 query = scene.query(random);
      if (!scene.is_moderate(query)) continue;
      const Truth truth = truth_of(scene.placed(), query, has_sides);
      // First with the pages and the work at hand.
      QueryOptions hasty{.wait = Wait::kNever};
      if (random.one_in(2)) hasty.max_work = static_cast<std::uint32_t>(random.below(40));
      expect_holds(truth, scene.probe().closest_point(query, hasty));
      QueryOptions loose{.parts = kDistance};
      loose.max_error = random.magnitude(-30, 0);
      const SceneClosestPoint near = scene.probe().closest_point(query, loose);
      expect_holds(truth, near);
      if (near.status == Status::kWithinError) {
        EXPECT_LE(near.upper - near.lower, loose.max_error);
      } else {
        EXPECT_EQ(near.status, Status::kExact);
      }
      EXPECT_EQ(scene.probe().closest_point(query, {.parts = kDistance}).status, Status::kExact);
      const SceneClosestPoint answer = scene.probe().closest_point(query);
      expect_holds(truth, answer);
      EXPECT_NE(answer.instance, kNoInstance);
      EXPECT_LE(abs(Real(answer.distance) - truth.distance), Real(answer.upper - answer.lower));
      ++total;
      exact += answer.status == Status::kExact;
      const SceneContainment side = scene.probe().contains(query);
      known += side.side != Side::kUnknown;
      if (!has_sides) continue;
      if (side.side == Side::kInside) {
        EXPECT_FALSE(truth.is_outside);
      }
      if (side.side == Side::kOutside) {
        EXPECT_FALSE(truth.is_inside);
      }
    }
  }
  // Many queries are on a surface, where a moved instance cannot tell its side.
  EXPECT_GT(exact, total / 4);
  EXPECT_GT(known, total / 4);
}

TEST(ScenesOfClosedModels, AnswerAsAllTrianglesDo) { check_queries(closed_families(), true, 1); }
TEST(ScenesOfClosedModels, AreTouchedAsAllTrianglesAre) { check_sweeps(closed_families(), 3); }
TEST(ScenesOfNastyModels, AreTouchedAsAllTrianglesAre) { check_sweeps(nasty_families(), 4); }
TEST(ScenesOfNastyModels, AnswerAsAllTrianglesDo) { check_queries(nasty_families(), false, 2); }

}  // namespace
}  // namespace planetree::oracle
