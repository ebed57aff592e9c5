#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "planetree/probe.h"
#include "tests/cache/allocation_count.h"
#include "tests/query/answer_bits.h"
#include "tests/query/eventually.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

// A sphere of 8,192 triangles.
class Ways : public testing::Test {
 protected:
  std::vector<Ray> rays(std::size_t count) const {
    const std::vector<Vec3> ends = random_queries(2 * count, -1.5, 1.5);
    std::vector<Ray> made;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 &from = ends[2 * i], &to = ends[2 * i + 1];
      made.push_back({from, {to.x - from.x, to.y - from.y, to.z - from.z}});
    }
    return made;
  }
  std::vector<Sweep> sweeps(std::size_t count) const {
    const std::vector<Vec3> ends = random_queries(2 * count, -1.5, 1.5);
    std::vector<Sweep> made;
    for (std::size_t i = 0; i < count; ++i)
      made.push_back(
          {ends[2 * i], ends[2 * i + 1], i % 3 == 0 ? 0 : 0.02 * static_cast<double>(i % 7)});
    return made;
  }

  const SampleModel sample_ = SampleModel::masked(octree::sphere(5));
};

// In the model frame the range of the least direction is rounded to [0, least]. A hit at the origin
// is then within it, as far as is known, and its `t` stays within what was given.
TEST_F(Ways, OfTheLeastDirectionHitWithinTheirRange) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const double least = std::numeric_limits<double>::denorm_min();
  std::vector<RayHit> hits(8);
  std::size_t count = 0;
  for (const Vec3& end : {Vec3{3, 0, 0}, Vec3{0, -3, 0}, Vec3{0, 0, 3}})
    for (const double x : {-least, least})
      for (const double y : {-least, least})
        for (const double z : {-least, least}) {
          const Vec3 origin = probe.closest_point(end).point;
          const Found found = probe.all_hits({origin, {x, y, z}, 0.25, 1}, hits);
          count += found.count;
          for (std::size_t i = 0; i < found.count; ++i) {
            EXPECT_GE(hits[i].t, 0.25);
            EXPECT_LE(hits[i].t, 1);
            EXPECT_LE(hits[i].t_lower, hits[i].t);
            EXPECT_GE(hits[i].t_upper, hits[i].t);
          }
        }
  EXPECT_GT(count, 0u);
}

// A ray from the centre leaves a closed surface once, also through its edges and vertices.
TEST_F(Ways, LeaveASphereOnce) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  std::vector<RayHit> hits(4);
  for (const Vec3& query : random_queries(300, -1.5, 1.5)) {
    const ClosestPoint nearest = probe.closest_point(query);
    Vec3 at = nearest.point;
    const Found found = probe.all_hits({{0, 0, 0}, at}, hits);
    ASSERT_TRUE(found.complete);
    ASSERT_EQ(found.count, 1u);
    EXPECT_FALSE(hits[0].entering);
    EXPECT_NEAR(hits[0].t, 1, 1e-12);
    EXPECT_GT(hits[0].normal.x * at.x + hits[0].normal.y * at.y + hits[0].normal.z * at.z, 0.9);
  }
  for (const Vec3& axis : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{1, 1, 0}}) {
    EXPECT_EQ(probe.all_hits({{0, 0, 0}, axis}, hits).count, 1u);
    EXPECT_EQ(probe.all_hits({{-3 * axis.x, -3 * axis.y, -3 * axis.z}, axis}, hits).count, 2u);
    EXPECT_TRUE(hits[0].entering);
    EXPECT_FALSE(hits[1].entering);
  }
}

TEST_F(Ways, AreTheSameInLittleMemoryAndInBatches) {
  const Model large = sample_.open(), small = sample_.open(sample_.min_budget());
  Probe of_large = make_probe(large), of_small = make_probe(small);
  const std::vector<Ray> lines = rays(200);
  std::vector<RayHit> hits(lines.size());
  of_small.first_hits(lines, hits);
  for (std::size_t i = 0; i < lines.size(); ++i)
    EXPECT_EQ(bits_of(hits[i]), bits_of(of_large.first_hit(lines[i])));
  const std::vector<Sweep> motions = sweeps(200);
  std::vector<FirstContact> contacts(motions.size());
  of_small.first_contacts(motions, contacts);
  std::size_t free = 0;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    EXPECT_EQ(bits_of(contacts[i]), bits_of(of_large.first_contact(motions[i])));
    free += contacts[i].free;
  }
  EXPECT_GT(free, 20u);
  EXPECT_LT(free, 180u);
}

TEST_F(Ways, ComeWithoutWaitingOnceThePagesAreThere) {
  const Model model = sample_.open(), other = sample_.open();
  Probe probe = make_probe(model), exact = make_probe(other);
  const QueryOptions options{.wait = Wait::kNever};
  int incomplete = 0;
  for (const Ray& ray : rays(20)) {
    const RayHit expected = exact.first_hit(ray);
    RayHit hit = probe.first_hit(ray, options);
    incomplete += hit.status == Status::kDegraded;
    EXPECT_LE(hit.t_lower, expected.t_upper);
    EXPECT_TRUE(eventually([&] {
      hit = probe.first_hit(ray, options);
      return hit.status == Status::kExact;
    }));
    EXPECT_EQ(bits_of(hit), bits_of(expected));
  }
  const Model cold = sample_.open();
  Probe mover = make_probe(cold);
  for (const Sweep& sweep : sweeps(20)) {
    const FirstContact expected = exact.first_contact(sweep);
    FirstContact contact = mover.first_contact(sweep, options);
    incomplete += contact.status == Status::kDegraded;
    EXPECT_LE(contact.t_lower, expected.t_upper);
    EXPECT_FALSE(contact.free && !expected.free);
    EXPECT_TRUE(eventually([&] {
      contact = mover.first_contact(sweep, options);
      return contact.status == Status::kExact;
    }));
    EXPECT_EQ(bits_of(contact), bits_of(expected));
  }
  EXPECT_GT(incomplete, 6);
}

TEST_F(Ways, AllHitsComeWithoutWaitingToo) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  std::vector<RayHit> hits(8);
  EXPECT_TRUE(eventually([&] {
    const Found found = probe.all_hits({{-2, 0.1, 0.2}, {1, 0, 0}}, hits, {.wait = Wait::kNever});
    return found.complete && found.count == 2;
  }));
}

TEST_F(Ways, DoNotAllocate) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  std::vector<RayHit> hits(20);
  const std::vector<Ray> lines = rays(20);
  const std::vector<Sweep> motions = sweeps(20);
  std::vector<FirstContact> contacts(20);
  probe.closest_point({0, 0, 2});
  const std::uint64_t allocations = cache::allocation_count();
  for (const Wait wait : {Wait::kForPages, Wait::kNever}) {
    const QueryOptions options{.wait = wait};
    for (const Ray& ray : lines) {
      probe.first_hit(ray, options);
      probe.all_hits(ray, hits, options);
    }
    for (const Sweep& sweep : motions) probe.first_contact(sweep, options);
    probe.first_hits(lines, hits, options);
    probe.first_contacts(motions, contacts, options);
  }
  EXPECT_EQ(cache::allocation_count(), allocations);
}

// Queries of every kind count in Probe::work_spent().
TEST_F(Ways, AndAllOtherQueriesSpendWork) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  std::vector<ClosestPoint> found(8);
  std::vector<RayHit> hits(8);
  std::uint64_t before = 0;
  const auto spent = [&] { return probe.work_spent() - std::exchange(before, probe.work_spent()); };
  const Vec3 query{0.9, 0.2, 0.1};
  const Ray ray{query, {-2, 0.3, 0.1}};
  probe.closest_point(query);
  EXPECT_GT(spent(), 0u);
  probe.contacts(query, 0.2, found);
  EXPECT_GT(spent(), 0u);
  probe.nearest_triangles(query, found);
  EXPECT_GT(spent(), 0u);
  probe.triangles_within(query, 0.2, found);
  EXPECT_GT(spent(), 0u);
  probe.triangles_within(Box{{0.8, 0, 0}, {1, 0.2, 0.2}}, found);
  EXPECT_GT(spent(), 0u);
  probe.first_hit(ray);
  EXPECT_GT(spent(), 0u);
  probe.all_hits(ray, hits);
  EXPECT_GT(spent(), 0u);
  probe.first_contact({query, {-1, 0, 0}, 0.01});
  EXPECT_GT(spent(), 0u);
}

// Consecutive motions of a point never pass through the surface unseen.
TEST_F(Ways, OfAPointDoNotTunnel) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  for (const Vec3& end : random_queries(100, -1.5, 1.5)) {
    if (probe.contains(end).side != Side::kOutside) continue;
    int contacts = 0;
    constexpr int kTicks = 50;
    const auto at = [&](int tick) {
      const double share = double(tick) / kTicks;
      return Vec3{end.x * share, end.y * share, end.z * share};
    };
    for (int tick = 0; tick < kTicks; ++tick)
      contacts += probe.first_contact({at(tick), at(tick + 1), 0}).free ? 0 : 1;
    EXPECT_GE(contacts, 1);
    EXPECT_LE(contacts, 2);
  }
}

TEST_F(Ways, KeepToTheLimitsOfTheQuery) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const Ray ray{{-2, 0.1, 0.2}, {2, 0, 0}};
  const RayHit hit = probe.first_hit(ray);
  EXPECT_EQ(hit.status, Status::kExact);
  const RayHit beyond = probe.first_hit(ray, {.max_distance = 0.5});
  EXPECT_EQ(beyond.status, Status::kBeyondMaxDistance);
  EXPECT_EQ(beyond.t, kForever);
  EXPECT_NEAR(beyond.t_lower, 0.25, 1e-9);
  const RayHit spent = probe.first_hit(ray, {.max_work = 0});
  EXPECT_EQ(spent.status, Status::kDegraded);
  EXPECT_LE(spent.t_lower, hit.t);
  EXPECT_EQ(probe.first_hit({ray.origin, ray.direction, 0, hit.t * 0.999}).t, kForever);
  EXPECT_FALSE(probe.first_hit({ray.origin, ray.direction, hit.t * 1.001}).entering);

  const Sweep sweep{{-2, 0.1, 0.2}, {0, 0.1, 0.2}, 0.1};
  const FirstContact contact = probe.first_contact(sweep);
  EXPECT_EQ(contact.status, Status::kExact);
  EXPECT_NEAR(contact.at.distance, 0.1, 1e-12);
  EXPECT_LT(contact.at.normal.x, -0.9);
  const FirstContact ended = probe.first_contact(sweep, {.max_distance = 0.5});
  EXPECT_EQ(ended.status, Status::kBeyondMaxDistance);
  EXPECT_FALSE(ended.free);
  EXPECT_NEAR(ended.t_lower, 0.25, 1e-9);
  const FirstContact nothing = probe.first_contact(sweep, {.max_work = 0});
  EXPECT_EQ(nothing.status, Status::kDegraded);
  EXPECT_FALSE(nothing.free);
  EXPECT_LE(nothing.t_lower, contact.t);
  EXPECT_EQ(probe.first_contact({{1, 0, 0}, {3, 0, 0}, 0.5}).t, 0);
}

TEST_F(Ways, OfBadValuesAreBadQueries) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const double nan = std::nan("");
  std::vector<RayHit> hits(4);
  for (const Ray& ray :
       {Ray{{nan, 0, 0}, {1, 0, 0}}, Ray{{0, 0, 0}, {0, 0, 0}}, Ray{{0, 0, 0}, {kForever, 0, 0}},
        Ray{{0, 0, 0}, {1, 0, 0}, -1}, Ray{{0, 0, 0}, {1, 0, 0}, 2, 1},
        Ray{{0, 0, 0}, {1, 0, 0}, nan}, Ray{{0, 0, 0}, {1, 0, 0}, 0, nan}}) {
    EXPECT_EQ(probe.first_hit(ray).status, Status::kBadQuery);
    EXPECT_EQ(probe.all_hits(ray, hits).count, 0u);
  }
  for (const Sweep& sweep :
       {Sweep{{nan, 0, 0}, {1, 0, 0}, 1}, Sweep{{0, 0, 0}, {0, kForever, 0}, 1},
        Sweep{{0, 0, 0}, {0, 0, 0}, -1}, Sweep{{0, 0, 0}, {0, 0, 0}, nan}}) {
    const FirstContact answer = probe.first_contact(sweep);
    EXPECT_EQ(answer.status, Status::kBadQuery);
    EXPECT_FALSE(answer.free);
  }
}

}  // namespace
}  // namespace planetree::query
