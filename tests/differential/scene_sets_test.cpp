// Rays and contacts in scenes against all triangles of all their instances, in random places.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "tests/differential/scene_cases.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/queries/contact_oracle.h"

namespace planetree::oracle {
namespace {

RealPoint minus(const RealPoint& a, const RealPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Real dot(const RealPoint& a, const RealPoint& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// A ray in the frame of an instance.
struct RealRay {
  RealPoint origin, direction;
};

RealRay ray_in_frame(const Pose& pose, const Ray& ray) {
  const Rotation back = rotation(pose.rotation).inverse();
  return {back.of(minus(real(ray.origin), real(pose.translation))), back.of(real(ray.direction))};
}

// Where a line passes through a triangle, by more than these numbers err.
std::optional<Real> crossing(const RealRay& ray, const Corners& corners) {
  const RealPoint a = real(corners[0]);
  const RealPoint u = minus(real(corners[1]), a), v = minus(real(corners[2]), a);
  const RealPoint normal = cross(u, v), across = cross(minus(ray.origin, a), ray.direction);
  const Real volume = -dot(normal, ray.direction);
  const Real size = sqrt(dot(normal, normal) * dot(ray.direction, ray.direction));
  if (!(abs(volume) > Real(1e-20) * size)) return {};
  const Real second = dot(v, across) / volume, third = -dot(u, across) / volume;
  const Real margin = 1e-10;
  if (second < margin || third < margin || second + third > 1 - margin) return {};
  return Real(dot(normal, minus(ray.origin, a)) / volume);
}

// Whether a line passes by a triangle at a distance that long double shows.
bool passes_by(const RealRay& ray, const Corners& corners) {
  using Vector = std::array<long double, 3>;
  const auto from_origin = [&](const Vec3& corner) {
    return Vector{corner.x - static_cast<long double>(ray.origin[0]),
                  corner.y - static_cast<long double>(ray.origin[1]),
                  corner.z - static_cast<long double>(ray.origin[2])};
  };
  const Vector d{static_cast<long double>(ray.direction[0]),
                 static_cast<long double>(ray.direction[1]),
                 static_cast<long double>(ray.direction[2])};
  const Vector a = from_origin(corners[0]), b = from_origin(corners[1]),
               c = from_origin(corners[2]);
  const auto volume = [&d](const Vector& u, const Vector& v) {
    return d[0] * (u[1] * v[2] - u[2] * v[1]) + d[1] * (u[2] * v[0] - u[0] * v[2]) +
           d[2] * (u[0] * v[1] - u[1] * v[0]);
  };
  const long double parts[] = {volume(b, c), volume(c, a), volume(a, b)};
  const auto [least, greatest] = std::minmax({parts[0], parts[1], parts[2]});
  const long double slack = 1e-3L * std::max(-least, greatest);
  return least < -slack && greatest > slack;
}

// The first certain crossing of a ray with any instance.
Real first_crossing(const std::vector<Placed>& placed, const Ray& ray) {
  Real first = std::numeric_limits<double>::infinity();
  for (const Placed& each : placed) {
    const RealRay local = ray_in_frame(each.pose, ray);
    for (const Corners& corners : each.model->triangles()) {
      if (passes_by(local, corners)) continue;
      const auto t = crossing(local, corners);
      if (t && *t >= ray.t_min && *t <= ray.t_max) first = std::min<Real>(first, *t);
    }
  }
  return first;
}

Ray random_ray(Random& random, const SceneCase& scene) {
  const Vec3 from = scene.query(random), to = scene.query(random);
  const double factor = random.magnitude(-4, 4);
  Ray ray{from, {factor * (to.x - from.x), factor * (to.y - from.y), factor * (to.z - from.z)}};
  if (random.one_in(4)) ray.t_max = random.between(0, 1) / factor;
  if (random.one_in(4)) ray.t_min = std::min(ray.t_max, random.between(0, 0.5) / factor);
  return ray;
}

bool is_moved(const SceneCase& scene, InstanceId id) {
  const auto placed = std::ranges::find(scene.placed(), id, &Placed::id);
  const Pose& pose = placed->pose;
  return pose.rotation.w != 1 || pose.translation.x != 0 || pose.translation.y != 0 ||
         pose.translation.z != 0;
}

void check_rays(std::span<const NastyFamily> families, std::size_t seed) {
  Random random(seed);
  std::size_t hits = 0, certain = 0, free = 0;
  for (int i = 0; i < 5 * test_effort(); ++i) {
    SceneCase scene(random, families);
    for (int k = 0; k < 50 && !testing::Test::HasFailure(); ++k) {
      SCOPED_TRACE(testing::Message() << "scene " << i << " ray " << k);
      scene.move_some(random);
      const Ray ray = random_ray(random, scene);
      const double longest = std::max(
          {std::fabs(ray.direction.x), std::fabs(ray.direction.y), std::fabs(ray.direction.z)});
      if (!scene.is_moderate(ray.origin) || !(longest > 1e-20 && longest < 1e60)) continue;
      const Real truth = first_crossing(scene.placed(), ray);
      QueryOptions hasty{.wait = Wait::kNever};
      if (random.one_in(2)) hasty.max_work = static_cast<std::uint32_t>(random.below(40));
      const SceneRayHit now = scene.probe().first_hit(ray, hasty);
      EXPECT_LE(Real(now.t_lower), truth);
      const SceneRayHit hit = scene.probe().first_hit(ray);
      EXPECT_LE(Real(hit.t_lower), truth);
      EXPECT_LE(hit.t_lower, hit.t);
      EXPECT_GE(hit.t_upper, hit.t);
      EXPECT_EQ(hit.instance != kNoInstance, hit.t < std::numeric_limits<double>::infinity());
      // What is certain of a moved instance is farther from the edges than crossing() asks for.
      if (hit.t_upper < std::numeric_limits<double>::infinity() && is_moved(scene, hit.instance)) {
        EXPECT_LE(truth, Real(hit.t_upper));
      }
      QueryOptions near;
      near.max_distance = random.between(0, 2) * longest;
      const SceneRayHit nearby = scene.probe().first_hit(ray, near);
      EXPECT_LE(Real(nearby.t_lower), truth);
      if (nearby.status == Status::kExact && nearby.instance != kNoInstance) {
        EXPECT_EQ(nearby.t, hit.t);
      }
      hits += hit.instance != kNoInstance;
      certain +=
          hit.t_upper < std::numeric_limits<double>::infinity() && Real(hit.t_upper) >= truth;
      free += hit.t_lower == std::numeric_limits<double>::infinity();
    }
  }
  EXPECT_GT(hits, 60u);
  EXPECT_GT(certain, hits / 4);
  EXPECT_GT(free, 3u);
}

// Compares what was found of one instance with its triangles.
void expect_contacts_of(const Placed& placed, const Vec3& query, double radius,
                        std::span<const SceneClosestPoint> found, bool is_complete) {
  const Local local = to_local(placed.pose, query);
  std::vector<ClosestPoint> own;
  for (const SceneClosestPoint& contact : found) {
    if (contact.instance != placed.id) continue;
    ClosestPoint moved = contact;
    moved.point = to_local(placed.pose, contact.point).point;
    own.push_back(moved);
    const Real truth(exact_distance(
        local.point, std::span(placed.model->triangles()).subspan(contact.triangle, 1)));
    EXPECT_LE(Real(contact.lower), truth + local.slack);
    EXPECT_GE(Real(contact.upper), truth - local.slack);
  }
  const ContactOracle oracle(local.point, placed.model->triangles());
  EXPECT_EQ(oracle.fault(own, radius, is_complete), "") << "radius " << radius;
}

void check_contacts(std::span<const NastyFamily> families, std::size_t seed) {
  Random random(seed);
  std::size_t contacts = 0, mixed = 0, complete = 0;
  for (int i = 0; i < 8 * test_effort(); ++i) {
    SceneCase scene(random, families);
    for (int k = 0; k < 40 && !testing::Test::HasFailure(); ++k) {
      SCOPED_TRACE(testing::Message() << "scene " << i << " contacts " << k);
      scene.move_some(random);
      const Vec3 query = scene.query(random);
      if (std::fabs(query.x) + std::fabs(query.y) + std::fabs(query.z) > 1e6) continue;
      const SceneClosestPoint nearest = scene.probe().closest_point(query, {.parts = kDistance});
      const double radius = nearest.distance * random.between(1, 1 + random.magnitude(-8, 3));
      std::vector<SceneClosestPoint> found(1 + random.below(80));
      const Found set = scene.probe().contacts(query, radius, found, {.parts = kDistance});
      const auto all = std::span(found).first(set.count);
      EXPECT_TRUE(std::ranges::is_sorted(all, {}, [](const SceneClosestPoint& contact) {
        return std::pair(contact.distance, contact.instance);
      }));
      for (const Placed& each : scene.placed())
        expect_contacts_of(each, query, radius, all, set.complete);
      ASSERT_GT(set.count, 0u);
      EXPECT_EQ(found[0].instance, nearest.instance);
      EXPECT_EQ(found[0].triangle, nearest.triangle);
      contacts += set.count;
      complete += set.complete;
      mixed += all.back().instance != found[0].instance;
    }
  }
  EXPECT_GT(contacts, 300u);
  EXPECT_GT(complete, 100u);
  EXPECT_GT(mixed, 10u);
}

TEST(ScenesOfClosedModels, AreHitByRaysAsAllTrianglesAre) { check_rays(closed_families(), 5); }
TEST(ScenesOfNastyModels, AreHitByRaysAsAllTrianglesAre) { check_rays(nasty_families(), 6); }
TEST(ScenesOfClosedModels, HaveTheContactsOfAllTriangles) { check_contacts(closed_families(), 7); }
TEST(ScenesOfNastyModels, HaveTheContactsOfAllTriangles) { check_contacts(nasty_families(), 8); }

}  // namespace
}  // namespace planetree::oracle
