#include "octree/builder/mask/special_cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/cell_overlap.h"
#include "octree/geometry/predicates.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {
namespace {

// The cell from 0 to 1, with the triangles of a closed model that touch it.
struct InCell {
  Surface model;
  std::vector<Triangle> triangles;
  std::array<Point, 8> corners;
  std::array<std::int64_t, 8> winding{};

  explicit InCell(const Soup& soup) : model(in_double(soup)) {
    for (const Triangle& triangle : model.triangles())
      if (may_touch(triangle, Point(0, 0, 0), Point(1, 1, 1))) triangles.push_back(triangle);
    for (unsigned i = 0; i < 8; ++i) {
      corners[i] = Point(i & 1, i >> 1 & 1, i >> 2);
      winding[i] = model.winding(corners[i]);
    }
  }
  static std::vector<Triangle> in_double(const Soup& soup) {
    const auto point = [](const Vec3& p) { return Point(p.x, p.y, p.z); };
    std::vector<Triangle> triangles;
    for (const auto& [a, b, c] : soup) triangles.push_back({point(a), point(b), point(c)});
    return triangles;
  }
  std::optional<SpecialCell> special() const { return special_cell(triangles, corners, winding); }
  bool is(const SpecialCell& claim) const {
    return is_special_cell(claim, triangles, corners, winding);
  }
};

// A closed cone with its apex in the cell and its base a polygon beside or below the cell.
Soup cone(const Vec3& apex, const std::vector<Vec3>& rim) {
  Soup soup;
  for (std::size_t i = 0; i < rim.size(); ++i) {
    const Vec3 &a = rim[i], &b = rim[(i + 1) % rim.size()];
    soup.push_back({apex, a, b});
    if (i > 0 && i + 1 < rim.size()) soup.push_back({rim[0], b, a});
  }
  return soup;
}

std::vector<Vec3> ring(unsigned sides, double turn) {
  std::vector<Vec3> rim;
  for (unsigned i = 0; i < sides; ++i) {
    const double angle = turn + 2 * 3.14159265358979 * i / sides;
    rim.push_back({0.5 + 6 * std::cos(angle), 0.5 + 6 * std::sin(angle), -2});
  }
  return rim;
}

struct CellCase {
  const char* name;
  Soup soup;
  unsigned planes;
};

std::vector<CellCase> special_models() {
  std::vector<CellCase> cases = {
      {"plane", box({-9, -9, -9}, {9, 9, 0.3}), 1},
      {"plane of many triangles", box({-4, -4, -4}, {4, 4, 0.25}, 16), 1},
      {"askew plane", box({-9, -9, -9}, {9, 9, 0.5}), 1},
      {"edge", box({-9, -9, -9}, {9, 0.7, 0.3}), 2},
      {"corner of a cube", box({-9, -9, -9}, {0.5, 0.625, 0.4}, 3), 3},
      {"four planes", cone({0.5, 0.5, 0.6}, ring(4, 0.1)), 4},
      {"two layers of one plane",
       joined({box({-9, -9, -9}, {9, 9, 0.5}), box({-5, -7, -3}, {5, 5, 0.5})}), 1},
      {"nested corner",
       joined({box({-9, -9, -9}, {0.5, 0.5, 0.5}), box({-3, -3, -3}, {0.5, 0.5, 0.5})}), 3},
  };
  // An oblique plane through corners of the cell.
  Soup askew = box({-4, -4, -4}, {4, 4, 0});
  for (auto& triangle : askew)
    for (Vec3& p : triangle) p = {p.x, p.y, p.z + 1 - p.x};
  cases[2].soup = askew;
  return cases;
}

// What a special cell states about a point: its winding number, or that it is on the surface.
struct StatedSide {
  bool on_surface = false;
  int winding = 0;
};

StatedSide stated_side(const SpecialCell& claim, const Point& point) {
  int farthest = -1;
  for (unsigned i = 0; i < claim.plane_count; ++i) {
    const auto& [a, b, c] = claim.planes[i];
    farthest = std::max(farthest, orientation(a, b, c, point));
  }
  return {farthest == 0, farthest > 0 ? claim.beyond : claim.behind};
}

void expect_truth(const InCell& in_cell, const SpecialCell& claim) {
  for (int x = 0; x <= 8; ++x)
    for (int y = 0; y <= 8; ++y)
      for (int z = 0; z <= 8; ++z) {
        const Point point = Point(x, y, z) / 8;
        const bool on_surface = std::ranges::any_of(
            in_cell.triangles, [&](const Triangle& triangle) { return lies_on(point, triangle); });
        const StatedSide said = stated_side(claim, point);
        ASSERT_EQ(said.on_surface, on_surface) << point.transpose();
        if (!on_surface) {
          ASSERT_EQ(said.winding, in_cell.model.winding(point)) << point.transpose();
        }
      }
}

TEST(SpecialCells, DecideTheSideOfEveryPoint) {
  for (const CellCase& c : special_models())
    for (const bool turned : {false, true}) {
      SCOPED_TRACE(std::string(c.name) + (turned ? ", inside out" : ""));
      const InCell in_cell(turned ? inside_out(c.soup) : c.soup);
      EXPECT_TRUE(in_few_planes(in_cell.triangles));
      const auto special = in_cell.special();
      ASSERT_TRUE(special);
      EXPECT_EQ(special->plane_count, c.planes);
      EXPECT_TRUE(in_cell.is(*special));
      expect_truth(in_cell, *special);
    }
}

// In a cavity the solid is beyond the planes.
TEST(SpecialCells, MayBeConcave) {
  for (const CellCase& c : special_models()) {
    SCOPED_TRACE(c.name);
    const InCell hollow(joined({box({-20, -20, -20}, {20, 20, 20}), inside_out(c.soup)}));
    const auto special = hollow.special();
    ASSERT_TRUE(special);
    // A single plane is convex in either orientation.
    if (special->plane_count > 1) {
      EXPECT_EQ(special->beyond, 1);
      EXPECT_LE(special->behind, 0);
    }
    expect_truth(hollow, *special);
  }
}

// Corners on a plane may have either number, so they are not compared.
TEST(SpecialCells, IgnoreCornersOnAPlane) {
  // The solid behind the plane is at y > x. The step from a corner on the plane leads out of it.
  const auto shear = [](Soup soup) {
    for (auto& triangle : soup)
      for (Vec3& p : triangle) p = {p.x, p.x + p.y, p.z};
    return soup;
  };
  const InCell in_cell(shear(box({-9, 0, -9}, {9, 9, 9})));
  EXPECT_EQ(in_cell.winding[0], 0);
  EXPECT_EQ(in_cell.winding[2], 1);
  const auto special = in_cell.special();
  ASSERT_TRUE(special);
  EXPECT_TRUE(in_cell.is(*special));
  expect_truth(in_cell, *special);
}

TEST(SpecialCells, HaveAtMostFourPlanes) {
  const InCell five(cone({0.5, 0.5, 0.6}, ring(5, 0.1)));
  EXPECT_EQ(five.triangles.size(), 5u);
  EXPECT_FALSE(in_few_planes(five.triangles));
  EXPECT_FALSE(five.special());
}

TEST(SpecialCells, AreConvex) {
  // A step up at x = 0.5 has a convex and a concave edge.
  const InCell step(joined({box({-9, -9, -9}, {0.5, 9, 0.3}), box({0.5, -9, -9}, {9, 9, 0.7})}));
  EXPECT_FALSE(step.special());
  // A saddle: every other point of the rim is raised.
  std::vector<Vec3> rim = ring(4, 0);
  rim[0].z = rim[2].z = 8;
  const InCell saddle(cone({0.5, 0.5, 0.5}, rim));
  EXPECT_TRUE(in_few_planes(saddle.triangles));
  EXPECT_FALSE(saddle.special());
}

TEST(SpecialCells, HaveNoFacesBackToBack) {
  const InCell two(joined({box({-9, -9, -9}, {9, 9, 0.5}), box({-9, -9, 0.5}, {9, 9, 8})}));
  EXPECT_FALSE(in_few_planes(two.triangles));
  EXPECT_FALSE(two.special());
  const Triangle& one = two.triangles.front();
  EXPECT_FALSE(in_few_planes(std::array{one, Triangle{one[0], one[2], one[1]}}));
}

TEST(SpecialCells, HaveNoTriangleWithoutArea) {
  InCell in_cell(box({-9, -9, -9}, {9, 9, 0.5}));
  const Point a(0, 0, 0.5), b(1, 1, 0.5), c(0.5, 0.5, 0.5);
  for (const Triangle& flat : {Triangle{a, b, c}, Triangle{a, a, a}, Triangle{a, b, a}}) {
    auto triangles = in_cell.triangles;
    triangles.push_back(flat);
    EXPECT_FALSE(in_few_planes(triangles));
    EXPECT_FALSE(special_cell(triangles, in_cell.corners, in_cell.winding));
  }
}

// Where a plane only touches the cell, no corner is beyond it, so the side there is unknown.
TEST(SpecialCells, HaveACornerBeyondEveryPlane) {
  EXPECT_FALSE(InCell(box({-9, -9, -9}, {9, 9, 1})).special());
  EXPECT_FALSE(InCell(box({-9, -9, -9}, {9, 1, 0.5})).special());
  EXPECT_FALSE(InCell(box({-9, -9, -9}, {9, 9, 0})).special());
  EXPECT_FALSE(InCell(box({-9, -9, 0}, {9, 9, 9})).special());
  // An edge within the cell has corners on both sides.
  EXPECT_TRUE(InCell(box({-9, -9, -9}, {9, 0.75, 0.5})).special());
}

TEST(SpecialCells, RequireConsistentCorners) {
  const InCell edge(box({-9, -9, -9}, {9, 0.75, 0.5}));
  for (unsigned corner = 0; corner < 8; ++corner) {
    InCell changed = edge;
    changed.winding[corner] += 1;
    // Only corners 0 and 1 are behind both planes.
    EXPECT_FALSE(changed.special()) << corner;
    EXPECT_FALSE(changed.is(*edge.special())) << corner;
  }
  InCell same = edge;
  same.winding.fill(3);
  EXPECT_FALSE(same.special());
}

TEST(SpecialCells, StoreWindingNumbersInOneByte) {
  const InCell plane(box({-9, -9, -9}, {9, 9, 0.5}));
  const auto with = [&](std::int64_t behind, std::int64_t beyond) {
    InCell changed = plane;
    for (unsigned i = 0; i < 8; ++i) changed.winding[i] = i < 4 ? behind : beyond;
    return changed.special();
  };
  const auto largest = with(127, -127);
  ASSERT_TRUE(largest);
  EXPECT_EQ(largest->behind, 127);
  EXPECT_EQ(largest->beyond, -127);
  EXPECT_FALSE(with(128, 0));
  EXPECT_FALSE(with(0, 128));
  EXPECT_FALSE(with(-128, 0));
  EXPECT_FALSE(with(0, -128));
  EXPECT_FALSE(with(256, 0));
  EXPECT_FALSE(with(std::int64_t{1} << 32 | 1, 0));
}

class SpecialCellClaims : public testing::Test {
 protected:
  SpecialCellClaims()
      : in_cell_(box({-9, -9, -9}, {0.5, 0.75, 0.25})), claim_(*in_cell_.special()) {
    EXPECT_EQ(claim_.plane_count, 3u);
    EXPECT_TRUE(in_cell_.is(claim_));
  }
  InCell in_cell_;
  SpecialCell claim_;
};

TEST_F(SpecialCellClaims, AreRefusedWithOtherNumbers) {
  SpecialCell swapped = claim_;
  std::swap(swapped.behind, swapped.beyond);
  EXPECT_FALSE(in_cell_.is(swapped));
  SpecialCell behind = claim_, beyond = claim_;
  behind.behind = 2;
  beyond.beyond = -1;
  EXPECT_FALSE(in_cell_.is(behind));
  EXPECT_FALSE(in_cell_.is(beyond));
}

TEST_F(SpecialCellClaims, AreRefusedWithAPlaneShiftedByAnUlp) {
  for (unsigned plane = 0; plane < claim_.plane_count; ++plane)
    for (unsigned axis = 0; axis < 3; ++axis)
      for (const double towards : {-9.0, 9.0}) {
        SpecialCell shifted = claim_;
        for (Point& corner : shifted.planes[plane])
          corner[axis] = std::nextafter(corner[axis], towards);
        // A plane may move along itself, but not across, along any axis that its normal has a part
        // of.
        const auto& [a, b, c] = claim_.planes[plane];
        EXPECT_EQ(in_cell_.is(shifted), normal_sign(a, b, c, axis) == 0) << plane << ' ' << axis;
        SpecialCell tilted = claim_;
        tilted.planes[plane][1][axis] = std::nextafter(tilted.planes[plane][1][axis], towards);
        EXPECT_EQ(in_cell_.is(tilted), normal_sign(a, b, c, axis) == 0) << plane << ' ' << axis;
      }
}

TEST_F(SpecialCellClaims, AreRefusedWithAPlaneTurnedOrMissing) {
  for (unsigned plane = 0; plane < claim_.plane_count; ++plane) {
    SpecialCell turned = claim_;
    std::swap(turned.planes[plane][1], turned.planes[plane][2]);
    EXPECT_FALSE(in_cell_.is(turned)) << plane;
    SpecialCell missing = claim_;
    missing.planes[plane] = missing.planes[--missing.plane_count];
    EXPECT_FALSE(in_cell_.is(missing)) << plane;
  }
  SpecialCell none = claim_;
  none.plane_count = 0;
  EXPECT_FALSE(in_cell_.is(none));
}

TEST_F(SpecialCellClaims, AreRefusedWithAPlaneThatIsNoFace) {
  ASSERT_LT(claim_.plane_count, kMaxPlanes);
  SpecialCell more = claim_;
  // A plane that cuts off the least corner of the cell.
  more.planes[more.plane_count++] = {Point(0.125, 0, 0), Point(0, 0, 0.125), Point(0, 0.125, 0)};
  EXPECT_FALSE(in_cell_.is(more));
  // A plane without area.
  more.planes[3] = {Point(0, 0, 0), Point(0, 0, 0), Point(0, 0, 0)};
  EXPECT_FALSE(in_cell_.is(more));
}

// A triangle behind all planes, on none of them.
TEST_F(SpecialCellClaims, AreRefusedWithATriangleOffThePlanes) {
  InCell more = in_cell_;
  more.triangles.push_back({Point(0, 0, 0.125), Point(0.25, 0, 0.125), Point(0, 0.25, 0.125)});
  EXPECT_FALSE(more.is(claim_));
  EXPECT_TRUE(in_cell_.is(claim_));
}

}  // namespace
}  // namespace planetree::octree
