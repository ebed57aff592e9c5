#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "planetree/probe.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"
#include "tests/storage/file/file_image.h"

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

TEST_F(Contains, FindsTheSideOfEveryPoint) {
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

TEST_F(Contains, BatchesGiveTheAnswersOfSingleQueries) {
  const Model model = sample_.open(), small = sample_.open(sample_.min_budget());
  Probe probe = make_probe(model), of_small = make_probe(small);
  std::vector<Containment> answers(queries_.size());
  of_small.contains(queries_, answers);
  for (std::size_t i = 0; i < queries_.size(); ++i) {
    const Containment alone = probe.contains(queries_[i]);
    ASSERT_EQ(answers[i].side, alone.side) << i;
    ASSERT_EQ(answers[i].status, alone.status) << i;
  }
}

TEST_F(Contains, AgreesWithTheSideOfAClosestPoint) {
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

TEST_F(Contains, ReadsPagesOnlyForTheRequestedParts) {
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

TEST_F(Contains, ComputesOnlyTheRequestedParts) {
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
  const Containment found = probe.contains({0.2, 0.3, 0.4}, {.max_work = 2});
  EXPECT_EQ(found.side, Side::kUnknown);
  EXPECT_EQ(found.status, Status::kDegraded);
  EXPECT_EQ(model.stats().degraded_answers, 1u);
  EXPECT_EQ(probe.contains({5, 0, 0}, {.max_work = 0}).side, Side::kOutside);
}

// Where one exit segment needs a lost page, another is used.
TEST_F(Contains, FindsSidesWithoutALostPage) {
  storage::FileImage image(storage::read_bytes(sample_.path()));
  image.stored(sample_.page_count() - 2)[0] ^= std::byte{1};
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

/// A sphere with a hole about +z that is wider than a page.
class ContainsOpen : public testing::Test {
 protected:
  static octree::Soup bowl() {
    octree::Soup soup;
    for (const auto& triangle : octree::sphere(5))
      if (triangle[0].z + triangle[1].z + triangle[2].z < 3 * 0.9) soup.push_back(triangle);
    return soup;
  }
  /// Sum of solid angles over 4 pi, for points that are not near the surface.
  static double winding(const octree::Soup& soup, const Vec3& query) {
    const octree::Point q(query.x, query.y, query.z);
    double sum = 0;
    for (const auto& t : soup) {
      const auto way = [&](const Vec3& p) {
        return octree::Point(octree::Point(p.x, p.y, p.z) - q);
      };
      const octree::Point a = way(t[0]), b = way(t[1]), c = way(t[2]);
      const double la = a.norm(), lb = b.norm(), lc = c.norm();
      sum += std::atan2(a.dot(b.cross(c)),
                        la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return sum / (2 * std::numbers::pi);
  }

  ContainsOpen() : sample_(bowl()), queries_(random_queries(400, -1.3, 1.3)) {}

  octree::Soup soup_ = bowl();
  SampleModel sample_;
  std::vector<Vec3> queries_;
};

TEST_F(ContainsOpen, FindsTheSideByTheWindingNumber) {
  const Model model = sample_.open();
  ASSERT_FALSE(model.info().watertight());
  Probe probe = make_probe(model);
  int inside = 0;
  for (const Vec3& query : queries_) {
    const double w = winding(soup_, query);
    if (std::fabs(std::fabs(w) - 0.5) < 1e-9) continue;
    const Containment found = probe.contains(query);
    EXPECT_EQ(found.side, std::fabs(w) > 0.5 ? Side::kInside : Side::kOutside) << w;
    EXPECT_EQ(found.status, Status::kExact);
    inside += found.side == Side::kInside;
  }
  EXPECT_GT(inside, 30);
  EXPECT_EQ(probe.contains(soup_[7][0]).side, Side::kOnSurface);
  EXPECT_EQ(probe.contains({1e300, 0, 0}).side, Side::kOutside);
  EXPECT_LT(probe.closest_point({0, 0, -0.5}).signed_distance(), 0);
  EXPECT_GT(probe.closest_point({0, 0, 1.5}).signed_distance(), 0);
}

TEST_F(ContainsOpen, BatchesWithLittleMemoryGiveTheAnswersOfSingleQueries) {
  const Model model = sample_.open(), small = sample_.open(sample_.min_budget());
  Probe probe = make_probe(model), of_small = make_probe(small);
  std::vector<Containment> answers(queries_.size());
  of_small.contains(queries_, answers);
  for (std::size_t i = 0; i < queries_.size(); ++i) {
    const Containment alone = probe.contains(queries_[i]);
    ASSERT_EQ(answers[i].side, alone.side) << i;
    ASSERT_EQ(answers[i].status, alone.status) << i;
  }
}

TEST_F(ContainsOpen, IsDegradedWhenTheWorkEnds) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  const Containment found = probe.contains({0.2, 0.3, -0.4}, {.max_work = 1});
  EXPECT_EQ(found.side, Side::kUnknown);
  EXPECT_EQ(found.status, Status::kDegraded);
  EXPECT_EQ(model.stats().degraded_answers, 1u);
  EXPECT_EQ(model.stats().degraded_without_misses, 1u);
  // With enough work the side is known, and more work does not change it.
  Side side = Side::kUnknown;
  for (std::uint32_t nodes = 2; nodes < 300; ++nodes) {
    const Containment now = probe.contains({0.2, 0.3, -0.4}, {.max_work = nodes});
    EXPECT_EQ(now.side == Side::kUnknown, now.status == Status::kDegraded);
    if (side != Side::kUnknown) {
      EXPECT_EQ(now.side, side);
    }
    side = now.side;
  }
  EXPECT_EQ(side, Side::kInside);
}

// From afar, moments stand in for the content of a lost page.
TEST_F(ContainsOpen, IsRightWhereALostPageCannotMatter) {
  storage::FileImage image(storage::read_bytes(sample_.path()));
  image.stored(sample_.page_count() / 2)[0] ^= std::byte{1};
  storage::write_bytes(sample_.path(), image.bytes());
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  int unknown = 0;
  for (const Vec3& query : queries_) {
    const double w = winding(soup_, query);
    const Containment found = probe.contains(query);
    unknown += found.side == Side::kUnknown;
    EXPECT_EQ(found.side == Side::kUnknown, found.status == Status::kDegraded);
    if (found.side == Side::kUnknown || std::fabs(std::fabs(w) - 0.5) < 1e-9) continue;
    EXPECT_EQ(found.side, std::fabs(w) > 0.5 ? Side::kInside : Side::kOutside);
  }
  EXPECT_GT(unknown, 0);
  EXPECT_LT(unknown, 100);
}

// Normals point out of the solid, as for a watertight surface. At a point on the surface, the
// winding number of the remaining surface decides.
TEST_F(ContainsOpen, TurnsNormalsOutOfTheSolid) {
  octree::Soup inside_out = soup_;
  for (auto& triangle : inside_out) std::swap(triangle[1], triangle[2]);
  const SampleModel turned(inside_out);
  const Model model = sample_.open(), turned_model = turned.open();
  Probe probes[] = {make_probe(model), make_probe(turned_model)};
  const auto& [a, b, c] = soup_[100];
  const Vec3 queries[] = {a, {a.x * 0.9, a.y * 0.9, a.z * 0.9}, {a.x * 1.1, a.y * 1.1, a.z * 1.1}};
  for (Probe& probe : probes)
    for (const Vec3& query : queries) {
      const Vec3 normal = probe.closest_point(query).normal;
      EXPECT_GT(normal.x * a.x + normal.y * a.y + normal.z * a.z, 0.9);
    }
}

// The faces of this bowl face inward, so that the sign of a winding number turns their normals. An
// answer that lacks a page or work for that sign is not exact.
class InwardBowl : public ContainsOpen {
 protected:
  static octree::Soup turned(octree::Soup soup) {
    for (auto& triangle : soup) std::swap(triangle[1], triangle[2]);
    return soup;
  }

  InwardBowl() {
    const Model whole = turned_.open();
    Probe probe = make_probe(whole);
    for (std::size_t at = 0; at < soup_.size(); at += 13) {
      queries_.push_back(soup_[at][0]);
      truths_.push_back(probe.closest_point(soup_[at][0]).normal);
      const Vec3& n = truths_.back();
      const Vec3& q = queries_.back();
      EXPECT_GT(n.x * q.x + n.y * q.y + n.z * q.z, 0.2);
    }
  }

  void expect_exact_only_if_right(Probe& probe, const QueryOptions& options) {
    for (std::size_t at = 0; at < queries_.size(); ++at) {
      const ClosestPoint answer = probe.closest_point(queries_[at], options);
      const Vec3 &truth = truths_[at], &found = answer.normal;
      exact_ += answer.status == Status::kExact;
      degraded_ += answer.status == Status::kDegraded;
      if (answer.status != Status::kExact) continue;
      EXPECT_EQ(answer.side, Side::kOnSurface);
      EXPECT_TRUE(found.x == truth.x && found.y == truth.y && found.z == truth.z) << at;
    }
  }

  SampleModel turned_{turned(bowl())};
  std::vector<Vec3> queries_, truths_;
  int exact_ = 0, degraded_ = 0;
};

TEST_F(InwardBowl, NormalsOnTheSurfaceAreNotExactWithoutAPageForTheirSign) {
  const storage::Bytes bytes = storage::read_bytes(turned_.path());
  const std::uint32_t pages = turned_.open().info().pages;
  for (std::uint32_t page = 1; page < pages; ++page) {
    storage::FileImage image(bytes);
    image.stored(page)[0] ^= std::byte{1};
    storage::write_bytes(turned_.path(), image.bytes());
    const Model model = turned_.open();
    Probe probe = make_probe(model);
    expect_exact_only_if_right(probe, {});
  }
  EXPECT_GT(exact_, 100);
  EXPECT_GT(degraded_, 100);
}

TEST_F(InwardBowl, NormalsOnTheSurfaceAreNotExactWithoutWorkForTheirSign) {
  const Model model = turned_.open();
  Probe probe = make_probe(model);
  for (std::uint32_t work = 1; work < 1000; work += 1 + work / 8)
    expect_exact_only_if_right(probe, {.max_work = work});
  EXPECT_GT(exact_, 100);
  EXPECT_GT(degraded_, 100);
}

TEST_F(ContainsOpen, IsOutsideOnBothSidesOfAHeightField) {
  const SampleModel sample(octree::height_field(10));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  for (const double z : {-0.3, 0.3}) {
    const ClosestPoint answer = probe.closest_point({0.5, 0.5, z});
    EXPECT_EQ(answer.side, Side::kOutside);
    EXPECT_EQ(answer.status, Status::kExact);
    EXPECT_GT(answer.signed_distance(), 0);
    EXPECT_GT(answer.normal.z * z, 0);
  }
}

}  // namespace
}  // namespace planetree::query
