// Scenes against all triangles of all their instances, exactly, in random places.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

// v turned by q / |q|, or turned back: v + 2 w (u x v) + 2 u x (u x v) for a unit quaternion w + u.
RealPoint turned(const RealPoint& v, const Quaternion& q, int direction) {
  const Real x = q.x, y = q.y, z = q.z, w = q.w;
  const Real length = sqrt(x * x + y * y + z * z + w * w);
  const RealPoint u{direction * x / length, direction * y / length, direction * z / length};
  const auto cross = [](const RealPoint& a, const RealPoint& b) -> RealPoint {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const RealPoint once = cross(u, v), twice = cross(u, once);
  RealPoint sum;
  for (std::size_t i = 0; i < 3; ++i) sum[i] = v[i] + 2 * (w / length) * once[i] + 2 * twice[i];
  return sum;
}

// A point in the frame of an instance: the nearest doubles, and how far they are off.
struct Local {
  Vec3 point;
  Real slack;
};

Local to_local(const Pose& pose, const Vec3& world) {
  const RealPoint from = real(world), t = real(pose.translation);
  const RealPoint exact =
      turned({from[0] - t[0], from[1] - t[1], from[2] - t[2]}, pose.rotation, -1);
  const Vec3 point{double(exact[0]), double(exact[1]), double(exact[2])};
  Real slack = 0;
  for (std::size_t i = 0; i < 3; ++i) slack += abs(exact[i] - real(point)[i]);
  return {point, slack};
}

Vec3 to_world(const Pose& pose, const Vec3& local) {
  const RealPoint turned_point = turned(real(local), pose.rotation, 1);
  return {double(turned_point[0] + pose.translation.x),
          double(turned_point[1] + pose.translation.y),
          double(turned_point[2] + pose.translation.z)};
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
TEST(ScenesOfNastyModels, AnswerAsAllTrianglesDo) { check_queries(nasty_families(), false, 2); }

}  // namespace
}  // namespace planetree::oracle
