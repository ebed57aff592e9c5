// The judge accepts right answers and reports wrong ones, however the mesh is split into rounds and
// parts.

#include "tests/oracle/answer_judge.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>
#include <sstream>

#include "tests/oracle/closed_models.h"
#include "tests/oracle/random.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::oracle {
namespace {

// Several rounds of several parts; the last ones are short.
constexpr JudgeLimits kShortRounds{100, 30, 200'000'000};

AnswerRow row_of(const Vec3& query, const ClosestPoint& answer) {
  return {query,       answer.distance, answer.lower,  answer.upper,
          answer.side, answer.triangle, answer.status, {}};
}

// A mesh, its answers, and their judgement.
class JudgedMesh {
 public:
  explicit JudgedMesh(const Soup& soup) : model_(soup) { write_ply(mesh(), soup); }

  std::filesystem::path mesh() const { return folder_ / "mesh.ply"; }
  AnswerRow closest_point(const Vec3& query, const QueryOptions& options = {}) {
    return row_of(query, model_.closest_point(query, options));
  }
  Judgement judge(std::span<const AnswerRow> rows, const JudgeLimits& limits = kShortRounds) const {
    auto judgement = judge_answers(mesh(), rows, limits);
    if (!judgement) ADD_FAILURE() << judgement.error().text;
    return *std::move(judgement);
  }
  std::string fault(const AnswerRow& row) const { return judge(std::span(&row, 1)).faults.at(0); }

 private:
  storage::TemporaryDirectory folder_;
  BuiltModel model_;
};

// A ball that intersects a box, and a second box that touches the first.
Soup solids() {
  return ball(2) + box({0.5, -0.25, -0.25}, {2, 0.25, 0.25}) + box({2, -1, -1}, {3, 1, 1});
}

Soup open_solids() {
  Soup soup = solids();
  soup.erase(soup.begin() + 5);
  return soup;
}

// Queries anywhere around, on corners, edges and faces, and on rays along x through all of these.
std::vector<Vec3> points_about(const Soup& soup) {
  Random random(11);
  std::vector<Vec3> queries;
  for (int i = 0; i < 60; ++i) queries.push_back(random.in_cube() * 3.5);
  for (int i = 0; i < 20; ++i) {
    const Corners& t = soup[random.below(soup.size())];
    const Vec3 middle = (t[0] + t[1]) * 0.5;
    for (const Vec3& on : {t[0], middle, point_on(random, t)}) {
      queries.push_back(on);
      for (const double step : {-2.0, -0x1p-40, 0x1p-40, 0.25})
        queries.push_back(on + Vec3{step, 0, 0});
    }
  }
  return queries;
}

void expect_all_right(const Soup& soup, const Judgement& judgement) {
  EXPECT_EQ(judgement.triangles, soup.size());
  for (const std::string& fault : judgement.faults) EXPECT_EQ(fault, "");
}

TEST(AnswerJudge, AcceptsRightAnswersOfAWatertightMesh) {
  const Soup soup = solids();
  JudgedMesh mesh(soup);
  std::vector<AnswerRow> rows;
  for (const Vec3& query : points_about(soup)) rows.push_back(mesh.closest_point(query));
  for (const JudgeLimits& limits : {kShortRounds, JudgeLimits{}}) {
    const Judgement judgement = mesh.judge(rows, limits);
    expect_all_right(soup, judgement);
    EXPECT_TRUE(judgement.watertight);
    EXPECT_EQ(judgement.sides_by_crossings, rows.size());
    EXPECT_EQ(judgement.sides_by_solid_angles, rows.size() / 10);
  }
}

TEST(AnswerJudge, AcceptsRightAnswersOfAnOpenMesh) {
  const Soup soup = open_solids();
  JudgedMesh mesh(soup);
  std::vector<AnswerRow> rows;
  for (const Vec3& query : points_about(soup)) rows.push_back(mesh.closest_point(query));
  const Judgement judgement = mesh.judge(rows);
  expect_all_right(soup, judgement);
  EXPECT_FALSE(judgement.watertight);
  EXPECT_EQ(judgement.sides_by_crossings, 0U);
  EXPECT_EQ(judgement.sides_by_solid_angles, rows.size() / 10);
}

// If the limit is too low, no side of a watertight mesh is summed; of an open mesh as many as it
// allows.
TEST(AnswerJudge, SumsSolidAnglesWithinItsLimits) {
  for (const Soup& soup : {solids(), open_solids()}) {
    JudgedMesh mesh(soup);
    const std::vector<AnswerRow> rows(100, mesh.closest_point({0, 0, 0}));
    for (const std::size_t affordable : {0, 1, 7, 10, 20}) {
      const JudgeLimits limits{100, 30, soup.size() * affordable + 1};
      const Judgement judgement = mesh.judge(rows, limits);
      const std::size_t wanted = judgement.watertight && affordable < 10 ? 0 : affordable;
      EXPECT_LE(judgement.sides_by_solid_angles, std::min<std::size_t>(wanted, 10));
      EXPECT_GE(2 * judgement.sides_by_solid_angles, std::min<std::size_t>(wanted, 10));
    }
  }
}

TEST(AnswerJudge, AcceptsRightInexactAnswers) {
  const Soup soup = solids();
  JudgedMesh mesh(soup);
  std::vector<AnswerRow> rows;
  std::map<Status, std::size_t> counts;
  for (const Vec3& query : points_about(soup)) {
    rows.push_back(mesh.closest_point(query, {.max_error = 0.5}));
    rows.push_back(mesh.closest_point(query, {.max_distance = 0.5}));
    rows.push_back(mesh.closest_point(query, {.max_work = 1}));
    rows.push_back(mesh.closest_point(query, {.max_error = -1}));
  }
  for (const AnswerRow& row : rows) ++counts[row.status];
  EXPECT_EQ(counts.size(), 5U);
  for (const auto& [status, count] : counts) EXPECT_GT(count, 10U);
  const Judgement judgement = mesh.judge(rows);
  expect_all_right(soup, judgement);
  EXPECT_EQ(judgement.not_judged, rows.size() / 4);
}

// A change to a right answer, and text that the judge must report then.
struct FaultCase {
  const char* expected;
  std::function<void(AnswerRow&)> change;
};

void expect_found(const JudgedMesh& mesh, const AnswerRow& right, const FaultCase& fault_case) {
  ASSERT_EQ(mesh.fault(right), "");
  AnswerRow wrong = right;
  fault_case.change(wrong);
  EXPECT_NE(mesh.fault(wrong).find(fault_case.expected), std::string::npos)
      << "not '" << fault_case.expected << "' but '" << mesh.fault(wrong) << "'";
}

// The query is 0.5 away from a face of the last box.
TEST(AnswerJudge, FindsEveryFaultInAnExactAnswer) {
  const Soup soup = solids();
  JudgedMesh mesh(soup);
  const AnswerRow right = mesh.closest_point({3.5, 0.25, 0.5});
  const std::uint64_t far = 0;
  const FaultCase fault_cases[] = {
      {"is nearer than the interval",
       [](AnswerRow& row) {
         row.lower = std::nextafter(0.5, 1);
         row.distance = row.upper = 0.6;
       }},
      {"is nearer than the interval",
       [&](AnswerRow& row) {
         // As if the nearest triangle had been missed: names another one, with its true distance.
         const AnswerRow other = mesh.closest_point({3.5, 0.25, 0.5});
         const auto distance = static_cast<double>(extended_distance(other.query, soup[far]));
         row.triangle = far;
         row.distance = distance;
         row.lower = distance * (1 - 1e-15);
         row.upper = distance * (1 + 1e-15);
       }},
      {"farther than the interval", [&](AnswerRow& row) { row.triangle = far; }},
      {"farther than the interval",
       [](AnswerRow& row) { row.distance = row.lower = row.upper = std::nextafter(0.5, 0); }},
      {"not within the interval", [](AnswerRow& row) { row.distance = 0.6; }},
      {"not within the interval", [](AnswerRow& row) { row.distance = 0.4; }},
      {"not within the interval", [](AnswerRow& row) { std::swap(row.lower, row.upper); }},
      {"is nearer than the interval",
       [](AnswerRow& row) {
         row.lower = row.distance = row.upper = std::numeric_limits<double>::infinity();
       }},
      {"nothing can be answered",
       [](AnswerRow& row) { row.query.y = std::numeric_limits<double>::quiet_NaN(); }},
      {"no such triangle", [&](AnswerRow& row) { row.triangle = soup.size(); }},
      {"names no triangle", [](AnswerRow& row) { row.triangle = kNoTriangle; }},
      {"point is outside", [](AnswerRow& row) { row.side = Side::kInside; }},
      {"point is outside", [](AnswerRow& row) { row.side = Side::kOnSurface; }},
      {"point is outside", [](AnswerRow& row) { row.side = Side::kUnknown; }}};
  for (const FaultCase& fault_case : fault_cases) expect_found(mesh, right, fault_case);
}

// Three or more faces meet at a corner; the first of them must be named.
TEST(AnswerJudge, FindsThatAnEqualTriangleComesFirst) {
  const Soup soup = solids();
  JudgedMesh mesh(soup);
  const AnswerRow right = mesh.closest_point({4, 2, 2});
  std::size_t others = 0;
  for (std::uint64_t i = 0; i < soup.size(); ++i) {
    if (i == right.triangle || extended_distance(right.query, soup[i]) > right.upper) continue;
    ++others;
    expect_found(mesh, right, {"comes before", [i](AnswerRow& row) { row.triangle = i; }});
  }
  EXPECT_GE(others, 2U);
}

TEST(AnswerJudge, FindsWrongSidesWhereverThePointIs) {
  JudgedMesh mesh(solids());
  const auto says = [](Side side) { return [side](AnswerRow& row) { row.side = side; }; };
  const AnswerRow inside = mesh.closest_point({0.75, 0, 0});  // inside two solids
  expect_found(mesh, inside, {"point is inside", says(Side::kOutside)});
  const AnswerRow on = mesh.closest_point({3, 0, 0});
  expect_found(mesh, on, {"on the surface", says(Side::kOutside)});
  expect_found(mesh, on, {"on the surface", says(Side::kInside)});
}

TEST(AnswerJudge, FindsWrongSidesOfAnOpenMesh) {
  JudgedMesh mesh(open_solids());
  const auto says = [](Side side) { return [side](AnswerRow& row) { row.side = side; }; };
  expect_found(mesh, mesh.closest_point({2.5, 0, 0}), {"point is inside", says(Side::kOutside)});
  expect_found(mesh, mesh.closest_point({4, 0, 0}), {"point is outside", says(Side::kInside)});
  expect_found(mesh, mesh.closest_point({3, 0, 0}), {"on the surface", says(Side::kInside)});
}

TEST(AnswerJudge, FindsFaultsInInexactAnswers) {
  JudgedMesh mesh(solids());
  const Vec3 query{3.5, 0.25, 0.5};
  const auto too_high = [](AnswerRow& row) { row.lower = std::nextafter(0.5, 1); };
  const auto too_low = [](AnswerRow& row) {
    row.lower = 0;
    row.distance = row.upper = std::nextafter(0.5, 0);
  };
  const AnswerRow within = mesh.closest_point(query, {.max_error = 1});
  expect_found(mesh, within, {"not within the interval", [](AnswerRow& row) { row.upper = 0.1; }});
  expect_found(mesh, within, {"farther than the interval", too_low});
  const AnswerRow beyond = mesh.closest_point(query, {.max_distance = 0.25});
  expect_found(mesh, beyond, {"nearer than the interval", too_high});
  const AnswerRow degraded = mesh.closest_point(query, {.max_work = 0});
  ASSERT_EQ(degraded.triangle, kNoTriangle);
  expect_found(mesh, degraded, {"no triangle is within", too_low});
}

TEST(AnswerJudge, ReportsAMissingMesh) {
  const auto judgement = judge_answers("/nonexistent/mesh.ply", {});
  ASSERT_FALSE(judgement);
  EXPECT_EQ(judgement.error().code, ErrorCode::kNotFound);
}

TEST(AnswerRows, ReadsTheOutputOfQuery) {
  std::istringstream csv(
      "x,y,z,distance,lower,upper,side,px,py,pz,nx,ny,nz,triangle,feature,status\n"
      "1,-2,0.5,3,2.5,3.5,on_surface,0,0,0,0,0,1,17,edge,within_error\n"
      "nan,0,0,inf,0,inf,unknown,0,0,0,0,0,1,,face,bad_query\n"
      "never read\n");
  const auto rows = read_answers(csv, 2);
  ASSERT_TRUE(rows) << rows.error().text;
  ASSERT_EQ(rows->size(), 2U);
  const AnswerRow& first = rows->front();
  EXPECT_EQ(first.query.y, -2);
  EXPECT_EQ(first.distance, 3);
  EXPECT_EQ(first.lower, 2.5);
  EXPECT_EQ(first.upper, 3.5);
  EXPECT_EQ(first.side, Side::kOnSurface);
  EXPECT_EQ(first.triangle, 17U);
  EXPECT_EQ(first.status, Status::kWithinError);
  EXPECT_EQ(rows->back().triangle, kNoTriangle);
  EXPECT_EQ(rows->back().upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(rows->back().status, Status::kBadQuery);
}

TEST(AnswerRows, RefusesMalformedRows) {
  const std::string header = "x,y,z,distance,lower,upper,side,triangle,status\n";
  for (const std::string& text :
       {std::string(), std::string("x,y,z,side,status\n0,0,0,inside,exact\n"),
        header + "0,0,0,1,1,1,inside,4\n", header + "0,0,0,1,1,1,beside,4,exact\n",
        header + "0,0,0,1,1,1,inside,4,good\n", header + "0,0,zero,1,1,1,inside,4,exact\n",
        header + "0,0,0,1,1,1,inside,four,exact\n"}) {
    std::istringstream csv(text);
    const auto rows = read_answers(csv, 10);
    ASSERT_FALSE(rows) << text;
    EXPECT_EQ(rows.error().code, ErrorCode::kBadInput);
  }
}

}  // namespace
}  // namespace planetree::oracle
