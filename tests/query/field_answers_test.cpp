// Answers that the coarse field gives or narrows.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <vector>

#include "planetree/planetree.h"
#include "tests/octree/support/sample_tree.h"
#include "tests/query/sample_model.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Vec3& a) { return std::sqrt(dot(a, a)); }

// A sphere of 32,768 triangles and radius 1, built as programs build it.
class FieldAnswers : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<storage::TemporaryDirectory>();
    build_soup(octree::sphere(6), *folder_ / "model.ptree");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::filesystem::path path() { return *folder_ / "model.ptree"; }
  static Model open(std::uint64_t budget = std::uint64_t{64} << 20) {
    OpenOptions options;
    options.memory_budget_bytes = budget;
    auto model = Model::open(path(), options);
    if (!model) throw std::runtime_error(model.error().text);
    return *std::move(model);
  }

  static std::unique_ptr<storage::TemporaryDirectory> folder_;
};

std::unique_ptr<storage::TemporaryDirectory> FieldAnswers::folder_;

TEST_F(FieldAnswers, WithinAnErrorNeedNoPage) {
  const Model model = open();
  Probe probe = make_probe(model);
  const QueryOptions tolerant{.parts = kDistance, .max_error = 0.2};
  const std::uint64_t before = model.stats().pages_read;
  for (const Vec3& query : random_queries(500, -1.2, 1.2)) {
    const ClosestPoint answer = probe.closest_point(query, tolerant);
    EXPECT_EQ(answer.status, Status::kWithinError);
    EXPECT_LE(answer.upper - answer.lower, 0.2);
    EXPECT_EQ(answer.triangle, kNoTriangle);
  }
  EXPECT_EQ(model.stats().pages_read, before);
}

TEST_F(FieldAnswers, HoldTheExactDistance) {
  const Model model = open();
  Probe exact = make_probe(model), tolerant = make_probe(model);
  for (const double error : {1e-3, 1e-2, 0.05, 0.3, 5.0})
    for (const double reach : {1.0, 1.5, 20.0, 1e5})
      for (const Vec3& query : random_queries(150, -reach, reach, 7)) {
        const ClosestPoint truth = exact.closest_point(query, {.parts = kDistance});
        const ClosestPoint answer =
            tolerant.closest_point(query, {.parts = kDistance, .max_error = error});
        EXPECT_LE(answer.lower, truth.upper);
        EXPECT_GE(answer.upper, truth.lower);
        EXPECT_NE(answer.status, Status::kDegraded);
        EXPECT_LE(answer.upper - answer.lower, error);
        EXPECT_LE(length(answer.point - query), answer.upper * (1 + 1e-9));
      }
}

// Side and normal do not depend on the error: the side is exact, and the normal points from the
// surface point to the query outside, and away from it inside.
TEST_F(FieldAnswers, HaveExactSidesAndOutwardNormals) {
  const Model model = open();
  Probe exact = make_probe(model), tolerant = make_probe(model);
  std::size_t without_triangle = 0;
  for (const Vec3& query : random_queries(500, -1.5, 1.5)) {
    const ClosestPoint truth = exact.closest_point(query);
    const ClosestPoint answer = tolerant.closest_point(query, {.max_error = 0.3});
    EXPECT_EQ(answer.side, truth.side);
    EXPECT_NEAR(length(answer.normal), 1, 1e-12);
    if (answer.triangle != kNoTriangle) continue;
    ++without_triangle;
    const double along = dot(query - answer.point, answer.normal);
    EXPECT_GT(answer.side == Side::kInside ? -along : along, 0);
    // On a sphere the contact normal is radial.
    const bool is_narrow = answer.upper - answer.lower < answer.lower / 16;
    EXPECT_TRUE(!is_narrow || length(query) < 0.5 ||
                std::fabs(dot(answer.normal, query)) / length(query) > 0.9);
  }
  EXPECT_GT(without_triangle, 100u);
}

// The search leaves out what is not nearer than the field's bound by more than the error. Whatever
// is left, the answer is within the error.
TEST_F(FieldAnswers, AreWithinTheErrorAtAnyDistance) {
  const Model model = open();
  Probe probe = make_probe(model);
  for (const double reach : {1.5, 10.0, 100.0, 1e4, 1e6})
    for (const double error : {2e-5, 3e-4, 4e-3, 0.05, 0.6})
      for (const Vec3& query : random_queries(100, -reach, reach, 11)) {
        const ClosestPoint answer =
            probe.closest_point(query, {.parts = kDistance, .max_error = error});
        EXPECT_NE(answer.status, Status::kDegraded) << reach << ' ' << error;
        EXPECT_TRUE(answer.status == Status::kExact || answer.upper - answer.lower <= error);
      }
}

TEST_F(FieldAnswers, HaveNormalsTowardTheQueryIfAsked) {
  const Model model = open();
  Probe probe = make_probe(model);
  std::size_t inside = 0;
  for (const Vec3& query : random_queries(300, -1, 1)) {
    const ClosestPoint answer =
        probe.closest_point(query, {.normal_rule = NormalRule::kTowardQuery, .max_error = 0.3});
    if (answer.triangle != kNoTriangle) continue;
    inside += answer.side == Side::kInside;
    EXPECT_GT(dot(query - answer.point, answer.normal), 0);
  }
  EXPECT_GT(inside, 30u);
}

// The box of a subtree may bound the distance by less than the field does. Then no point of the
// surface is known that is so near.
TEST_F(FieldAnswers, WithinAnErrorHaveAPointInTheInterval) {
  const Model model = open();
  Probe probe = make_probe(model);
  std::size_t without_triangle = 0;
  for (const Vec3& direction : random_queries(400, -1, 1))
    for (const std::uint32_t work : {3U, 5U, 7U, 9U, 40U}) {
      const bool is_far = work > 9;
      const double size = length(direction) / (is_far ? 9000 : 1);
      const Vec3 query{direction.x / size, direction.y / size, direction.z / size};
      const double error = is_far ? 0.04 : 4;
      const ClosestPoint answer =
          probe.closest_point(query, {.parts = kDistance, .max_error = error, .max_work = work});
      if (answer.status != Status::kWithinError || answer.triangle != kNoTriangle) continue;
      ++without_triangle;
      EXPECT_LE(length(answer.point - query), answer.upper * (1 + 1e-9));
    }
  EXPECT_GT(without_triangle, 100u);
}

TEST_F(FieldAnswers, DependOnTheQueryAlone) {
  const Model model = open();
  const auto queries = random_queries(400, -1.3, 1.3);
  const QueryOptions tolerant{.parts = kDistance, .max_error = 0.01};
  std::vector<ClosestPoint> forward(queries.size()), backward(queries.size());
  Probe probe = make_probe(model);
  probe.closest_points(queries, forward, tolerant);
  std::vector<Vec3> reversed(queries.rbegin(), queries.rend());
  Probe other = make_probe(model);
  other.closest_points(reversed, backward, tolerant);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const ClosestPoint& again = backward[queries.size() - 1 - i];
    EXPECT_EQ(forward[i].lower, again.lower);
    EXPECT_EQ(forward[i].upper, again.upper);
    EXPECT_EQ(forward[i].triangle, again.triangle);
  }
}

// With no page but the root in memory, the interval is as narrow as the field.
TEST_F(FieldAnswers, NarrowAnswersWithoutPages) {
  OpenOptions options;
  options.memory_budget_bytes = std::uint64_t{64} << 20;
  const auto model = Model::open(path(), options);
  ASSERT_TRUE(model) << model.error().text;
  Probe exact = make_probe(*model);
  for (const Vec3& query : random_queries(60, -1.1, 1.1)) {
    const Model cold = open();
    Probe probe = make_probe(cold);
    const ClosestPoint answer =
        probe.closest_point(query, {.parts = kDistance, .wait = Wait::kNever});
    const ClosestPoint truth = exact.closest_point(query, {.parts = kDistance});
    EXPECT_LE(answer.lower, truth.upper);
    EXPECT_GE(answer.upper, truth.lower);
    EXPECT_LT(answer.upper - answer.lower, 0.2);
  }
}

// The triangle of the last answer may be far away. The field's point is then nearer, and the normal
// points from it to the query.
TEST_F(FieldAnswers, AreNearerThanTheLastTriangleAfterAJump) {
  const Model model = open();
  Probe probe = make_probe(model);
  int without_triangle = 0;
  for (const Vec3& query : random_queries(300, 1.05, 1.4)) {
    probe.closest_point({-1.01, 0, 0}, {.max_work = 4096});
    const ClosestPoint answer = probe.closest_point(query, {.max_work = 8});
    EXPECT_LE(answer.distance, answer.upper);
    if (answer.status != Status::kDegraded || answer.triangle != kNoTriangle) continue;
    ++without_triangle;
    const Vec3 away = query - answer.point;
    EXPECT_NEAR(dot(answer.normal, away), length(away), 1e-9);
  }
  EXPECT_GT(without_triangle, 200);
}

TEST_F(FieldAnswers, NarrowAnswersOfLittleWork) {
  const Model model = open();
  Probe probe = make_probe(model);
  double last = kInfinity;
  for (const std::uint32_t work : {0U, 4U, 8U, 16U, 32U, 64U, 128U}) {
    double sum = 0;
    for (const Vec3& query : random_queries(300, -1.2, 1.2)) {
      const ClosestPoint answer =
          probe.closest_point(query, {.parts = kDistance, .max_work = work});
      EXPECT_LT(answer.upper - answer.lower, 0.2);
      sum += answer.upper - answer.lower;
    }
    EXPECT_LE(sum, last) << work;
    last = sum;
  }
  EXPECT_LT(last, 1e-9);
}

TEST_F(FieldAnswers, KeepTheLimitOfDistance) {
  const Model model = open();
  Probe probe = make_probe(model);
  for (const double limit : {0.0, 0.2, 0.5, 3.0})
    for (const Vec3& query : random_queries(200, -2, 2)) {
      const double truth = probe.closest_point(query, {.parts = kDistance}).distance;
      const ClosestPoint answer =
          probe.closest_point(query, {.parts = kDistance, .max_error = 0.1, .max_distance = limit});
      const bool beyond = answer.status == Status::kBeyondMaxDistance;
      EXPECT_TRUE(beyond ? truth > limit : answer.lower <= limit);
      EXPECT_TRUE(beyond || truth <= limit + 0.1);
    }
}

// A damaged field costs narrow intervals, and no answer.
TEST_F(FieldAnswers, DoWithoutADamagedField) {
  storage::FileImage image(storage::read_bytes(path()));
  const std::uint32_t page = image.header().first_field_page();
  ASSERT_LT(page, image.header().first_mask_page());
  image.stored(page)[40] ^= std::byte{1};
  const std::filesystem::path damaged = *folder_ / "damaged.ptree";
  storage::write_bytes(damaged, image.bytes());
  const auto model = Model::open(damaged);
  ASSERT_TRUE(model) << model.error().text;
  EXPECT_TRUE(model->stats().field_damaged);
  EXPECT_FALSE(open().stats().field_damaged);
  const Model whole = open();
  Probe probe = make_probe(*model), other = make_probe(whole);
  for (const Vec3& query : random_queries(100, -1.2, 1.2)) {
    EXPECT_EQ(probe.closest_point(query).distance, other.closest_point(query).distance);
    EXPECT_NE(probe.closest_point(query, {.parts = kDistance, .max_error = 0.3}).triangle,
              kNoTriangle);
  }
}

TEST_F(FieldAnswers, CountTheFieldInTheFile) {
  const Model model = open();
  EXPECT_GT(model.info().section_bytes.field_pages, 0u);
  EXPECT_LT(model.info().section_bytes.field_pages, 4 * model.info().triangles);
}

}  // namespace
}  // namespace planetree::query
