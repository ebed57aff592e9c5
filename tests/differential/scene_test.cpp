// Scenes against all triangles of all their instances, exactly, in random places.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/differential/scene_cases.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/winding.h"

namespace planetree::oracle {
namespace {

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
