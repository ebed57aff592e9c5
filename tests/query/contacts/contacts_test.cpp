#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "planetree/probe.h"
#include "tests/cache/allocation_count.h"
#include "tests/query/answer_bits.h"
#include "tests/query/eventually.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr QueryOptions kAtOnce{.wait = Wait::kNever};

// A sphere of 8,192 triangles.
class Contacts : public testing::Test {
 protected:
  const SampleModel sample_ = SampleModel::masked(octree::sphere(5));
  std::vector<ClosestPoint> found_ = std::vector<ClosestPoint>(64);
};

TEST_F(Contacts, BeginWithTheNearestPoint) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  for (const Vec3& query : random_queries(300, -1.5, 1.5)) {
    const ClosestPoint nearest = probe.closest_point(query);
    const Found set = probe.contacts(query, nearest.distance * 1.01, found_);
    ASSERT_GT(set.count, 0u);
    EXPECT_EQ(bits_of(found_[0]), bits_of(nearest));
    EXPECT_EQ(probe.contacts(query, nearest.distance * 0.99, found_).count, 0u);
    EXPECT_EQ(probe.contacts(query, 9, found_, {.max_distance = nearest.distance / 2}).count, 0u);
  }
}

TEST_F(Contacts, AreTheSameInLittleMemory) {
  const Model large = sample_.open(), small = sample_.open(sample_.min_budget());
  Probe of_large = make_probe(large), of_small = make_probe(small);
  std::vector<ClosestPoint> other(found_.size());
  for (const Vec3& query : random_queries(50, -0.2, 0.2)) {
    const Found set = of_large.contacts(query, 1.1, found_);
    const Found again = of_small.contacts(query, 1.1, other);
    ASSERT_EQ(again.count, set.count);
    EXPECT_EQ(again.complete, set.complete);
    for (std::size_t i = 0; i < set.count; ++i) EXPECT_EQ(bits_of(other[i]), bits_of(found_[i]));
  }
}

TEST_F(Contacts, ComeWithoutWaitingOnceThePagesAreThere) {
  const Model other = sample_.open();
  Probe blocking = make_probe(other);
  std::vector<ClosestPoint> expected(found_.size());
  int incomplete = 0;
  for (const Vec3& query : random_queries(10, -1.2, 1.2)) {
    // Of a model just opened no page is there, however fast the fetch thread is.
    const Model model = sample_.open();
    Probe probe = make_probe(model);
    const double radius = 1.02 * blocking.closest_point(query).distance + 0.01;
    const Found all = blocking.contacts(query, radius, expected);
    Found set;
    EXPECT_TRUE(eventually([&] {
      set = probe.contacts(query, radius, found_, kAtOnce);
      incomplete += !set.complete;
      return set.complete && set.count == all.count && found_[0].status == Status::kExact;
    }));
    for (std::size_t i = 0; i < set.count; ++i) EXPECT_EQ(bits_of(found_[i]), bits_of(expected[i]));
  }
  EXPECT_GT(incomplete, 3);
}

// Whether each contact that is marked exact is among those expected. Counts the others.
bool exact_ones_are_among(std::span<const ClosestPoint> contacts,
                          std::span<const ClosestPoint> expected, int& degraded) {
  for (const ClosestPoint& contact : contacts) {
    degraded += contact.status != Status::kExact;
    const auto same = [&](const ClosestPoint& one) { return bits_of(one) == bits_of(contact); };
    if (contact.status == Status::kExact && !std::any_of(expected.begin(), expected.end(), same))
      return false;
  }
  return true;
}

TEST_F(Contacts, WithoutWaitingInLittleMemoryTellWhatIsProven) {
  const Model model = sample_.open(sample_.min_budget() + 12 * 4096), other = sample_.open();
  Probe probe = make_probe(model), blocking = make_probe(other);
  std::vector<ClosestPoint> expected(found_.size());
  int complete = 0, degraded = 0;
  // How many lack pages depends on the speed of the fetch thread.
  constexpr int kEnough = 400;
  int queries = 0;
  for (const Vec3& query : random_queries(40 * kEnough, -1.2, 1.2)) {
    if (++queries > kEnough && complete > 0 && degraded > 0) break;
    const double radius = 1.02 * blocking.closest_point(query).distance + 0.01;
    const Found all = blocking.contacts(query, radius, expected);
    for (int tick = 0; tick < 5; ++tick) {
      const Found set = probe.contacts(query, radius, found_, kAtOnce);
      complete += set.complete;
      ASSERT_TRUE(!set.complete || set.count == all.count);
      ASSERT_TRUE(exact_ones_are_among(std::span(found_).first(set.count),
                                       std::span(expected).first(all.count), degraded));
    }
  }
  EXPECT_GT(complete, 0);
  EXPECT_GT(degraded, 0);
}

TEST_F(Contacts, OfLittleWorkTellWhatIsProven) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  std::vector<ClosestPoint> expected(found_.size());
  const QueryOptions unlimited{.parts = kDistance};
  int complete = 0, incomplete = 0, degraded = 0;
  for (const Vec3& query : random_queries(300, -1.2, 1.2)) {
    const double radius = 1.02 * probe.closest_point(query).distance + 0.01;
    const Found all = probe.contacts(query, radius, expected, unlimited);
    for (const std::uint32_t work : {0U, 3U, 20U, 60U, 200U}) {
      QueryOptions limited = unlimited;
      limited.max_work = work;
      const Found set = probe.contacts(query, radius, found_, limited);
      (set.complete ? complete : incomplete) += 1;
      ASSERT_TRUE(!set.complete || set.count == all.count);
      ASSERT_TRUE(exact_ones_are_among(std::span(found_).first(set.count),
                                       std::span(expected).first(all.count), degraded));
    }
  }
  EXPECT_GT(complete, 100);
  EXPECT_GT(incomplete, 100);
  EXPECT_GT(degraded, 0);  // what is not decided is left out, so that few are
}

TEST_F(Contacts, DoNotAllocate) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  probe.contacts({0, 0, 2}, 2, found_);
  const std::uint64_t allocations = cache::allocation_count();
  for (const double radius : {0.0, 0.3, 1.1, kInfinity}) {
    probe.contacts({0.4, 0, 1}, radius, found_);
    probe.contacts({0.4, 0, 1}, radius, found_, kAtOnce);
  }
  EXPECT_EQ(cache::allocation_count(), allocations);
}

TEST_F(Contacts, RefuseQueriesOutOfRange) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Found& set :
       {probe.contacts({nan, 0, 0}, 1, found_), probe.contacts({0, 1e305, 0}, 1, found_),
        probe.contacts({0, 0, 0}, -1, found_), probe.contacts({0, 0, 0}, nan, found_),
        probe.contacts({0, 0, 0}, 2, found_, {.max_error = -1})}) {
    EXPECT_EQ(set.count, 0u);
    EXPECT_FALSE(set.complete);
  }
}

}  // namespace
}  // namespace planetree::query
