#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

#include "planetree/probe.h"
#include "tests/oracle/random.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

using octree::Point;
using Corners = std::array<Vec3, 3>;

Vec3 vec(const Point& p) { return {p.x(), p.y(), p.z()}; }
Point point(const Vec3& v) { return {v.x, v.y, v.z}; }

// An irregular triangulation of the unit square: vertices at random in the cells of a grid, cells
// cut along either diagonal, some triangles cut again into slivers. The square lies in the plane
// that `place` moves it to.
template <class Place>
Soup cut_square(std::size_t cells, const Place& place) {
  oracle::Random random(7);
  std::vector<Point> at;
  for (std::size_t i = 0; i <= cells; ++i)
    for (std::size_t j = 0; j <= cells; ++j) {
      const auto inside = [&](std::size_t k) {
        return k == 0 || k == cells ? 0 : random.between(-0.2, 0.2);
      };
      const double x = (static_cast<double>(i) + inside(i)) / static_cast<double>(cells);
      const double y = (static_cast<double>(j) + inside(j)) / static_cast<double>(cells);
      at.push_back(place(x, y));
    }
  Soup soup;
  const auto add = [&](const Point& a, const Point& b, const Point& c) {
    const auto cut = [&](const Point& u, const Point& v, const Point& w) {
      soup.push_back(Corners{vec(u), vec(v), vec(w)});
    };
    if (!random.one_in(8)) return cut(a, b, c);
    const Point middle = a + random.between(1e-7, 0.5) * (b - a) + 1e-7 * (c - a);
    cut(a, b, middle);
    cut(b, c, middle);
    cut(c, a, middle);
  };
  for (std::size_t i = 0; i < cells; ++i)
    for (std::size_t j = 0; j < cells; ++j) {
      const std::size_t k = i * (cells + 1) + j;
      const Point &a = at[k], &b = at[k + cells + 1], &c = at[k + cells + 2], &d = at[k + 1];
      if (random.one_in(2)) {
        add(a, b, c);
        add(a, c, d);
      } else {
        add(a, b, d);
        add(b, c, d);
      }
    }
  return soup;
}

// What a contact is on.
using Identity = std::tuple<std::uint64_t, Feature, bool, bool, bool>;
Identity identity_of(const ClosestPoint& contact) {
  const Vec3& shares = contact.barycentric;
  return {contact.triangle, contact.feature, shares.x > 0, shares.y > 0, shares.z > 0};
}

// Says what is wrong with the contacts of a ball on a plane, of which there must be one.
std::string plane_fault(Probe& probe, const Vec3& centre, double radius, const Point& normal) {
  std::array<ClosestPoint, 8> found;
  const Found set = probe.contacts(centre, radius, found);
  const ClosestPoint nearest = probe.closest_point(centre);
  if (set.count != 1 || !set.complete) return std::to_string(set.count) + " contacts";
  if (bits_of(found[0]) != bits_of(nearest)) return "not the nearest point";
  const Vec3& n = found[0].normal;
  const double off = (Point(n.x, n.y, n.z) - normal).norm();
  return off < 1e-6 ? "" : "normal " + std::to_string(off);  // slivers are rounded
}

struct PlaneCase {
  const char* name;
  Point origin, x, y;
};

class ContactsOnAPlane : public testing::TestWithParam<PlaneCase> {
 protected:
  Point place(double x, double y) const {
    return GetParam().origin + x * GetParam().x + y * GetParam().y;
  }
  const Soup soup_ = cut_square(60, [this](double x, double y) { return place(x, y); });
  const SampleModel sample_ = SampleModel(soup_);
  const Point normal_ = GetParam().x.cross(GetParam().y).normalized();

  Vec3 above(const Point& on_plane, double height) const {
    return vec(on_plane + height * normal_);
  }
};

// A ball that rolls over a plane has one contact, whatever triangles it passes.
TEST_P(ContactsOnAPlane, AreOne) {
  ASSERT_GT(sample_.page_count(), 50u);
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  for (const double height : {0.05, 1e-3, 1e-9})
    for (int i = 0; i < 3000; ++i) {
      const double t = i / 3000.0;
      const Vec3 centre = above(place(0.1 + 0.8 * t, 0.3 + 0.4 * t * t), height);
      ASSERT_EQ(plane_fault(probe, centre, height * 1.2, normal_), "") << i << ' ' << height;
    }
}

// Above edges and vertices, where rounding decides what is nearest.
TEST_P(ContactsOnAPlane, AreOneAboveEdgesAndVertices) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  oracle::Random random(3);
  for (int i = 0; i < 6000; ++i) {
    const Corners& corners = soup_[random.below(soup_.size())];
    const std::size_t k = random.below(3);
    const double share = random.one_in(2) ? 0 : random.unit();
    const Point from = point(corners[k]), to = point(corners[(k + 1) % 3]);
    const Point on = from + share * (to - from);
    const double height = random.magnitude(-30, -3);
    Vec3 centre = above(on, height);
    if (random.one_in(2)) centre.x = std::nextafter(centre.x, random.either_sign() * 9);
    const double radius = height * random.between(1.001, 1.5) + 1e-15;
    ASSERT_EQ(plane_fault(probe, centre, radius, normal_), "")
        << i << ' ' << share << ' ' << height;
  }
}

// The contact is on the same feature for as long as the nearest point is.
TEST_P(ContactsOnAPlane, KeepTheirIdentity) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  std::size_t changes = 0;
  Identity last{};
  std::vector<Identity> met;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 centre = above(place(0.2 + 0.6 * i / 4000.0, 0.5 + 0.1 * i / 4000.0), 0.01);
    std::array<ClosestPoint, 4> found;
    ASSERT_EQ(probe.contacts(centre, 0.012, found).count, 1u);
    const Identity identity = identity_of(found[0]);
    if (identity == last) continue;
    ++changes;
    last = identity;
    met.push_back(identity);
  }
  // On a line none comes back. It crosses some two triangles a cell.
  std::sort(met.begin(), met.end());
  EXPECT_EQ(std::adjacent_find(met.begin(), met.end()), met.end());
  EXPECT_GT(changes, 36u);
  EXPECT_LT(changes, 200u);
}

INSTANTIATE_TEST_SUITE_P(
    Planes, ContactsOnAPlane,
    testing::Values(PlaneCase{"flat", {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                    PlaneCase{"tilted", {0.3, -0.2, 0.7}, {0.8, 0.36, 0.48}, {-0.6, 0.48, 0.64}},
                    PlaneCase{"steep", {-1, 2, 5}, {0.1, 0.7, -0.3}, {0.9, -0.2, 0.4}}),
    [](const auto& plane) { return std::string(plane.param.name); });

// More triangles than are kept at once.
TEST(ContactsOfManyTriangles, AreOneOnAPlane) {
  const SampleModel sample(cut_square(60, [](double x, double y) { return Point(x, y, 0); }));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  std::vector<ClosestPoint> found(4);
  std::vector<ClosestPoint> triangles(20000);
  for (const double radius : {0.2, 0.3}) {
    EXPECT_GT(probe.triangles_within({0.5, 0.5, 0.01}, radius, triangles).count, 1000u);
    const Found set = probe.contacts({0.5, 0.5, 0.01}, radius, found);
    EXPECT_EQ(set.count, 1u);
    EXPECT_TRUE(set.complete) << radius;
  }
}

// More triangles meet at the tip of a cone than are kept at once. The nearest point is a contact
// all the same.
TEST(ContactsOfManyTriangles, BeginWithTheNearestPointAtATip) {
  constexpr std::size_t kCount = 1000;
  Soup soup;
  const auto rim = [](std::size_t i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i % kCount) / kCount;
    return Vec3{std::cos(turn), std::sin(turn), -1};
  };
  for (std::size_t i = 0; i < kCount; ++i)
    soup.push_back(Corners{Vec3{0, 0, 0}, rim(i), rim(i + 1)});
  const SampleModel sample(soup);
  const Model model = sample.open();
  Probe probe = make_probe(model);
  std::array<ClosestPoint, 4> found;
  for (const Vec3& above : {Vec3{0, 0, 0.5}, Vec3{0.01, 0.02, 0.5}, Vec3{0, 0, 0}}) {
    const Found set = probe.contacts(above, 0.6, found);
    EXPECT_EQ(set.count, 1u);
    EXPECT_FALSE(set.complete);
    EXPECT_EQ(bits_of(found[0]), bits_of(probe.closest_point(above)));
    EXPECT_EQ(found[0].status, Status::kExact);
  }
}

// Two walls that meet at an edge, each cut finely.
class ContactsInAGroove : public testing::Test {
 protected:
  Model open(double slope) const {
    build_soup(walls(slope), folder_ / "groove.ptree");
    auto model = Model::open(folder_ / "groove.ptree");
    EXPECT_TRUE(model);
    return std::move(*model);
  }

 private:
  static Soup walls(double slope) {
    Soup soup = cut_square(30, [&](double x, double y) { return Point(x, y, slope * x); });
    for (Corners other : Soup(soup)) {
      for (Vec3& corner : other) corner.x = -corner.x;
      std::swap(other[1], other[2]);
      soup.push_back(other);
    }
    return soup;
  }
  storage::TemporaryDirectory folder_;
};

TEST_F(ContactsInAGroove, AreOneOnEachWall) {
  const Model model = open(1);
  Probe probe = make_probe(model);
  std::array<ClosestPoint, 8> found;
  for (int i = 0; i < 500; ++i) {
    const double height = 0.1 + 0.5 * i / 500.0, y = 0.3 + 0.4 * i / 500.0;
    const double aside = 0.1 * height * std::sin(i);
    const Found set = probe.contacts({aside, y, height}, 0.8 * height, found);
    ASSERT_EQ(set.count, 2u) << i;
    ASSERT_TRUE(set.complete);
    for (const ClosestPoint& contact : std::span(found).first(2)) {
      EXPECT_EQ(contact.status, Status::kExact);
      const double way = contact.point.x > 0 ? -1 : 1;
      EXPECT_NEAR(contact.normal.x, way * std::sqrt(0.5), 1e-7);
      EXPECT_NEAR(contact.normal.z, std::sqrt(0.5), 1e-7);
    }
    EXPECT_LT(found[0].point.x * found[1].point.x, 0);
  }
}

// Also from below the walls, where these are a ridge with one contact.
TEST_F(ContactsInAGroove, HaveNormalsTowardTheQueryOnRequest) {
  const Model model = open(1);
  Probe probe = make_probe(model);
  std::array<ClosestPoint, 8> found;
  const QueryOptions toward{.normal_rule = NormalRule::kTowardQuery};
  ASSERT_EQ(probe.contacts({0.01, 0.5, 0.3}, 0.3, found, toward).count, 2u);
  EXPECT_NEAR(found[0].normal.z, std::sqrt(0.5), 1e-7);
  EXPECT_NEAR(found[1].normal.z, std::sqrt(0.5), 1e-7);
  ASSERT_EQ(probe.contacts({0.01, 0.5, -0.1}, 0.3, found, toward).count, 1u);
  EXPECT_NEAR(found[0].normal.z, -1, 1e-7);
  EXPECT_EQ(found[0].side, Side::kInside);  // behind the sheet
}

// The bottom of the groove rises by less than the allowed error between the walls.
TEST_F(ContactsInAGroove, AreOneWhereTheRiseIsAllowed) {
  const Model model = open(0.01);
  Probe probe = make_probe(model);
  std::array<ClosestPoint, 8> found;
  const Vec3 centre{0, 0.5, 0.2};
  const Found two = probe.contacts(centre, 0.3, found);
  ASSERT_EQ(two.count, 2u);
  // To the edge at the bottom it is farther than to the walls.
  const double rise = 0.2 - found[0].distance;
  EXPECT_EQ(probe.contacts(centre, 0.3, found, {.max_error = 0.9 * rise}).count, 2u);
  const Found one = probe.contacts(centre, 0.3, found, {.max_error = 1.1 * rise});
  EXPECT_EQ(one.count, 1u);
  EXPECT_TRUE(one.complete);
}

TEST_F(ContactsInAGroove, AreTheNearestIfNotAllFit) {
  const Model model = open(1);
  Probe probe = make_probe(model);
  std::array<ClosestPoint, 1> found;
  const Found set = probe.contacts({0.01, 0.5, 0.3}, 0.3, found);
  EXPECT_EQ(set.count, 1u);
  EXPECT_FALSE(set.complete);
  EXPECT_EQ(bits_of(found[0]), bits_of(probe.closest_point({0.01, 0.5, 0.3})));
  EXPECT_FALSE(probe.contacts({0.01, 0.5, 0.3}, 0.3, {}).complete);
}

// Corners that lie on edges of other triangles, and triangles that the mesh has twice.
TEST(ContactsOfASoup, AreOneWhereTrianglesTouch) {
  const Soup soup = {Corners{Vec3{0, 0, 0}, {2, 0, 0}, {1, -1, 0}},
                     Corners{Vec3{0, 0, 0}, {0.7, 0, 0}, {0.4, 1, 0}},
                     Corners{Vec3{0.7, 0, 0}, {2, 0, 0}, {1.5, 1, 0}},
                     Corners{Vec3{0, 0, 0}, {2, 0, 0}, {1, -1, 0}}};
  const SampleModel sample(soup);
  const Model model = sample.open();
  Probe probe = make_probe(model);
  std::array<ClosestPoint, 8> found;
  for (const double y : {-0.01, -1e-9, 0.0, 1e-9, 0.01})
    for (const double x : {0.5, 0.7, 1.5}) {
      const double radius = x == 0.7 && y == 0.01 ? 0.1001 : 0.11;
      const Found set = probe.contacts({x, y, 0.1}, radius, found);
      EXPECT_TRUE(set.complete);
      EXPECT_EQ(set.count, 1u) << x << ' ' << y;
    }
}

}  // namespace
}  // namespace planetree::query
