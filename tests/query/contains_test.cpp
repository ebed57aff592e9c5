#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "planetree/probe.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"
#include "tests/storage/file_image.h"

namespace planetree::query {
namespace {

class Contains : public testing::Test {
 protected:
  Contains() : sample_(octree::sphere(5)), queries_(random_queries(2600, -1.3, 1.3)) {
    queries_[3] = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
    queries_[1024] = {1e300, 0, 0};
    queries_[1025] = {1, 0, 0};  // a vertex
  }

  SampleModel sample_;
  std::vector<Vec3> queries_;
};

TEST_F(Contains, TellsTheSideOfEveryPoint) {
  const Model model = sample_.open();
  ASSERT_TRUE(model.info().watertight());
  Probe probe = make_probe(model);
  int inside = 0;
  for (std::size_t i = 0; i < queries_.size(); ++i) {
    const auto [x, y, z] = queries_[i];
    const Containment found = probe.contains(queries_[i]);
    if (i == 3) {
      EXPECT_EQ(found.status, Status::kBadQuery);
      continue;
    }
    ASSERT_EQ(found.status, Status::kExact);
    const double radius = std::sqrt(x * x + y * y + z * z);
    if (radius > 1 + 1e-6) {
      ASSERT_EQ(found.side, Side::kOutside);
    }
    if (radius < 0.998) {
      ASSERT_EQ(found.side, Side::kInside);
    }
    inside += found.side == Side::kInside;
  }
  EXPECT_EQ(probe.contains(queries_[1025]).side, Side::kOnSurface);
  EXPECT_GT(inside, 500);
}

TEST_F(Contains, HasInBatchesWhatItHasOneByOne) {
  const Model model = sample_.open(), small = sample_.open(sample_.least_budget());
  Probe probe = make_probe(model), of_small = make_probe(small);
  std::vector<Containment> answers(queries_.size());
  of_small.contains(queries_, answers);
  for (std::size_t i = 0; i < queries_.size(); ++i) {
    const Containment alone = probe.contains(queries_[i]);
    ASSERT_EQ(answers[i].side, alone.side) << i;
    ASSERT_EQ(answers[i].status, alone.status) << i;
  }
}

TEST_F(Contains, IsTheSideOfAClosestPoint) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  for (const Vec3& query : queries_) {
    const ClosestPoint answer = probe.closest_point(query);
    const Side side = probe.contains(query).side;
    ASSERT_EQ(answer.side, side);
    ASSERT_EQ(answer.signed_distance(), side == Side::kInside ? -answer.distance : answer.distance);
    ASSERT_EQ(std::signbit(answer.signed_distance()), side == Side::kInside);
  }
}

TEST_F(Contains, NeedsPagesOnlyForWhatIsAsked) {
  const Vec3 outside{5, 0, 0}, inside{0.2, 0.3, 0.4};
  const auto pages_for = [&](const Vec3& query, std::uint32_t parts) {
    const Model model = sample_.open();
    Probe probe = make_probe(model);
    probe.closest_point(query, {.parts = parts});
    return model.stats().pages_read;
  };
  const std::uint64_t to_open = sample_.open().stats().pages_read;
  EXPECT_EQ(pages_for(outside, kSide), to_open);
  EXPECT_EQ(pages_for(inside, 0), to_open);
  EXPECT_GT(pages_for(outside, kDistance), to_open);
  EXPECT_LT(pages_for(inside, kSide), pages_for(inside, kAllParts));
}

TEST_F(Contains, LeavesOutWhatIsNotAsked) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const Vec3 query{0.2, 0.3, 0.4};
  const ClosestPoint side = probe.closest_point(query, {.parts = kSide});
  EXPECT_EQ(side.side, Side::kInside);
  EXPECT_EQ(side.status, Status::kExact);
  EXPECT_EQ(side.triangle, kNoTriangle);
  ClosestPoint distance = probe.closest_point(query, {.parts = kDistance});
  EXPECT_EQ(distance.side, Side::kUnknown);
  distance.side = Side::kInside;
  const ClosestPoint both = probe.closest_point(query, {.parts = kDistance | kSide});
  EXPECT_EQ(bits_of(distance), bits_of(both));
  ClosestPoint all = probe.closest_point(query);
  EXPECT_GT(all.normal.x * query.x + all.normal.y * query.y + all.normal.z * query.z, 0.5);
  all.normal = {0, 0, 1};
  EXPECT_EQ(bits_of(all), bits_of(both));
  EXPECT_EQ(probe.closest_point(query, {.parts = 1u << 31}).status, Status::kBadQuery);
}

TEST_F(Contains, IsDegradedWhenTheWorkEnds) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const Containment found = probe.contains({0.2, 0.3, 0.4}, {.max_nodes = 2});
  EXPECT_EQ(found.side, Side::kUnknown);
  EXPECT_EQ(found.status, Status::kDegraded);
  EXPECT_EQ(model.stats().degraded_answers, 1u);
  EXPECT_EQ(probe.contains({5, 0, 0}, {.max_nodes = 0}).side, Side::kOutside);
}

// A way that another page can tell of is taken where one is lost.
TEST_F(Contains, GoesAroundAPageThatIsLost) {
  storage::FileImage image(storage::read_bytes(sample_.path()));
  const storage::PageEntry entry = image.entry(sample_.page_count() - 1);
  image.bytes()[entry.offset] ^= std::byte{1};
  storage::write_bytes(sample_.path(), image.bytes());
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  int unknown = 0;
  for (const Vec3& query : random_queries(500, -0.5, 0.5)) {
    const Containment found = probe.contains(query);
    if (found.status == Status::kExact) {
      ASSERT_EQ(found.side, Side::kInside);
    } else {
      ++unknown;
    }
  }
  EXPECT_EQ(unknown, 0);
  EXPECT_EQ(model.stats().quarantined_pages, 1u);
}

TEST(ContainsOpen, IsUnknownWhereTheSurfaceIsNotWatertight) {
  const SampleModel sample(octree::sheet(10));
  const Model model = sample.open();
  EXPECT_FALSE(model.info().watertight());
  Probe probe = make_probe(model);
  EXPECT_EQ(probe.contains({0.5, 0.5, 0.1}).side, Side::kUnknown);
  EXPECT_EQ(probe.closest_point({0.5, 0.5, 0.1}).status, Status::kExact);
  EXPECT_GT(probe.closest_point({0.5, 0.5, 0.3}).signed_distance(), 0);
}

}  // namespace
}  // namespace planetree::query
