// Sides and normals of open sheets by SideRule::kSurface, beside faces, edges, vertices and
// borders, compared with the nearest feature of 512 bits.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/oracle/closed_models.h"
#include "tests/oracle/front.h"
#include "tests/oracle/sheet_models.h"

namespace planetree::oracle {
namespace {

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

QueryOptions by_front() {
  QueryOptions options;
  options.side_rule = SideRule::kSurface;
  return options;
}

// A point beside a face, an edge or a vertex, of the border or not, at a distance between some
// powers of two.
Vec3 beside(Random& random, const Soup& sheet, double least = -36, double most = 6) {
  const Corners& t = sheet[random.below(sheet.size())];
  const std::size_t kind = random.below(4);
  const Vec3 at = kind == 0   ? t[random.below(3)]
                  : kind == 1 ? t[0] + (t[1] - t[0]) * random.unit()
                              : point_on(random, t);
  // Straight over a face, half of the time.
  if (!random.one_in(2)) return at + random.in_some_cube(least, most);
  const Vec3 u = t[1] - t[0], v = t[2] - t[0];
  const Vec3 normal{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
  return at + normal * random.signed_magnitude(least, most);
}

struct Tally {
  int wrong = 0, unknown = 0, ambiguous = 0;
};

void expect_side_of(BuiltModel& model, const Vec3& query, Tally& tally) {
  const ClosestPoint answer = model.closest_point(query, by_front());
  const FrontAnswer right = front_side(query, model.triangles());
  if (answer.side == Side::kUnknown) {
    EXPECT_EQ(answer.status, Status::kDegraded);
    ++tally.unknown;
    return;
  }
  EXPECT_EQ(answer.status, Status::kExact);
  EXPECT_EQ(model.probe().contains(query, by_front()).side, answer.side);
  if (right.is_ambiguous)
    ++tally.ambiguous;
  else if (answer.side != right.side)
    ++tally.wrong;
  QueryOptions two_sided = by_front();
  two_sided.normal_rule = NormalRule::kTowardQuery;
  const ClosestPoint toward = model.closest_point(query, two_sided);
  EXPECT_EQ(toward.status, Status::kExact);
  const double sign = answer.side == Side::kInside ? -1 : 1;
  EXPECT_EQ(toward.normal.x, sign * answer.normal.x);
  EXPECT_EQ(toward.normal.y, sign * answer.normal.y);
  EXPECT_EQ(toward.normal.z, sign * answer.normal.z);
  // From the winding number's point of view nothing changes about which way that is.
  two_sided.side_rule = SideRule::kSolid;
  EXPECT_EQ(model.closest_point(query, two_sided).normal.z, toward.normal.z);
}

void expect_sides(const Soup& sheet, std::uint64_t seed) {
  BuiltModel model(sheet, {4096, 1 << 20, 1});
  Random random(seed);
  Tally tally;
  const int count = static_cast<int>(1500 * test_effort());
  for (int i = 0; i < count; ++i) expect_side_of(model, beside(random, sheet), tally);
  for (int i = 0; i < count / 5; ++i) expect_side_of(model, beside(random, sheet, 6, 36), tally);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_LE(tally.unknown, count / 50);
  EXPECT_LE(tally.ambiguous, count / 5);
}

// Where the surface is nearer than doubles resolve, sides are right or unknown.
TEST(SheetSides, WithinAnUlpOfTheSurface) {
  Random random(7);
  Tally tally;
  for (const Soup& sheet : {hills(12), bowl(12), moebius_strip(32), holed_panel(9)}) {
    BuiltModel model(sheet, {4096, 1 << 20, 1});
    for (int i = 0; i < 500; ++i) expect_side_of(model, beside(random, sheet, -64, -44), tally);
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_LE(tally.unknown, 600);
}

// Degenerate, overlapping and needle-like faces, beside which many sides are unknown.
TEST(SheetSides, OfNastyModelsAreNeverWrong) {
  Random random(8);
  Tally tally;
  for (const NastyFamily& family : nasty_families()) {
    BuiltModel model(family.make(random), {4096, 1 << 20, 1});
    for (int i = 0; i < 60; ++i)
      expect_side_of(model, nasty_query(random, model.triangles(), 1), tally);
  }
  EXPECT_EQ(tally.wrong, 0);
}

TEST(SheetSides, BesideHills) { expect_sides(hills(12), 1); }
TEST(SheetSides, BesideABowl) { expect_sides(bowl(12), 2); }
TEST(SheetSides, BesideAHalfPipe) { expect_sides(half_pipe(12), 3); }
TEST(SheetSides, BesideAMoebiusStrip) { expect_sides(moebius_strip(32), 4); }
TEST(SheetSides, BesideAHoledPanel) { expect_sides(holed_panel(9), 5); }

// In the plane of the sheet, beyond its border or in a hole, nothing is in front or behind.
TEST(SheetSides, InThePlaneOfAPanelIsOutside) {
  BuiltModel model(holed_panel(9));
  for (const Vec3& query : {Vec3{3, 0.1, 0}, Vec3{-1.5, -7, 0}, Vec3{-0.67, -0.66, 0}}) {
    const ClosestPoint answer = model.closest_point(query, by_front());
    EXPECT_EQ(answer.side, Side::kOutside);
    EXPECT_EQ(answer.status, Status::kExact);
    EXPECT_EQ(answer.normal.z, 1);
  }
  EXPECT_EQ(model.closest_point({0.9, 0.9, 0}, by_front()).side, Side::kOnSurface);
  EXPECT_EQ(model.closest_point({0.9, 0.9, 1e-300}, by_front()).side, Side::kOutside);
  EXPECT_EQ(model.closest_point({0.9, 0.9, -1e-300}, by_front()).side, Side::kInside);
}

// A step along the sheet never turns the normal over.
TEST(SheetSides, NormalsDoNotJumpAlongABowl) {
  BuiltModel model(bowl(12));
  Vec3 last{0, 0, 0};
  for (const double height : {0.05, -0.05})
    for (int i = 0; i <= 400; ++i) {
      const ClosestPoint on = model.closest_point({i / 200.0 - 1, 0.3, 0.0}, by_front());
      const Vec3 query{on.point.x, on.point.y, on.point.z + height};
      const Vec3 normal = model.closest_point(query, by_front()).normal;
      EXPECT_GT(normal.z, 0);
      EXPECT_TRUE(i == 0 || dot(normal, last) > 0);
      last = normal;
    }
}

// A side without a proof never has status kExact.
TEST(SheetSides, LittleWorkAndMemoryNeverMakeAnUnprovenSideExact) {
  // Its pages take more than the budget.
  BuiltModel model(hills(150), {4096, 1100 << 10, 2});
  Random random(6);
  int unknown = 0;
  for (std::uint32_t work = 1; work <= 64; ++work)
    for (int i = 0; i < 6; ++i) {
      const Vec3 query = beside(random, model.triangles());
      const Side right = model.closest_point(query, by_front()).side;
      for (const Wait wait : {Wait::kForPages, Wait::kNever})
        for (const NormalRule normals : {NormalRule::kOutward, NormalRule::kTowardQuery}) {
          QueryOptions options = by_front();
          options.max_work = work;
          options.wait = wait;
          options.normal_rule = normals;
          const ClosestPoint answer = model.closest_point(query, options);
          EXPECT_TRUE(answer.side == right || answer.side == Side::kUnknown);
          if (right != Side::kUnknown && answer.side == Side::kUnknown) {
            EXPECT_EQ(answer.status, Status::kDegraded);
            ++unknown;
          }
          const Containment side = model.probe().contains(query, options);
          EXPECT_TRUE(side.side == right || side.side == Side::kUnknown);
          EXPECT_EQ(side.status == Status::kExact, side.side != Side::kUnknown);
        }
    }
  EXPECT_GT(unknown, 100);
}

TEST(SheetSides, TheBuilderTellsSheetsFromSolids) {
  const auto rule_of = [](const Soup& soup) {
    BuildChoices choices;
    choices.side = std::nullopt;
    return BuiltModel(soup, choices).model().info().side_rule;
  };
  EXPECT_EQ(rule_of(hills(12)), SideRule::kSurface);
  EXPECT_EQ(rule_of(bowl(12)), SideRule::kSurface);
  EXPECT_EQ(rule_of(half_pipe(12)), SideRule::kSurface);
  EXPECT_EQ(rule_of(holed_panel(9)), SideRule::kSurface);

  Soup cube = box({0, 0, 0}, {1, 2, 3});
  EXPECT_EQ(rule_of(cube), SideRule::kSolid);
  cube = box({0, 0, 0}, {1, 1, 1});
  cube.resize(cube.size() - 2);
  EXPECT_EQ(rule_of(cube), SideRule::kSolid);
  Soup holed = ball(4);
  for (std::ptrdiff_t i = 0; i < std::ssize(holed); i += 99) holed.erase(holed.begin() + i);
  EXPECT_EQ(rule_of(holed), SideRule::kSolid);
}

}  // namespace
}  // namespace planetree::oracle
