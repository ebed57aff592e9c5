// Sides of surfaces with holes against sums of solid angles.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "tests/oracle/built_model.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"
#include "tests/oracle/winding.h"

namespace planetree::oracle {
namespace {

struct OpenModel {
  std::string name;
  Soup present, missing;  ///< of the closed model, if it comes from one
};

/// Removes `count` faces of a soup, at random or those that are nearest to one of them.
OpenModel less(const std::string& name, Soup soup, std::size_t count, bool clustered,
               Random& random) {
  OpenModel model{name, {}, {}};
  const Vec3 middle = soup[random.below(soup.size())][0];
  for (; count > 0 && soup.size() > 1; --count) {
    std::size_t at = random.below(soup.size());
    const auto gap = [&](std::size_t i) {
      const Vec3 way = soup[i][0] - middle;
      return way.x * way.x + way.y * way.y + way.z * way.z;
    };
    for (std::size_t i = 0; clustered && i < soup.size(); ++i)
      if (gap(i) < gap(at)) at = i;
    model.missing.push_back(soup[at]);
    soup.erase(soup.begin() + static_cast<std::ptrdiff_t>(at));
  }
  model.present = std::move(soup);
  return model;
}

Soup moebius(unsigned count) {
  const auto at = [count](unsigned i, int side) {
    const double a = 2 * std::numbers::pi * i / count, half = a / 2;
    const double r = 1 + 0.3 * side * std::cos(half);
    return Vec3{r * std::cos(a), r * std::sin(a), 0.3 * side * std::sin(half)};
  };
  Soup soup;
  for (unsigned i = 0; i < count; ++i) {
    // The last quad joins the first with its sides exchanged.
    const bool last = i + 1 == count;
    const Vec3 a = at(i, -1), b = at(i, 1);
    const Vec3 c = last ? at(0, 1) : at(i + 1, -1), d = last ? at(0, -1) : at(i + 1, 1);
    soup.push_back({a, c, b});
    soup.push_back({b, c, d});
  }
  return soup;
}

Soup terrain(unsigned side) {
  const auto at = [](unsigned i, unsigned j) {
    return Vec3{1.0 * i, 1.0 * j, 0.25 * ((3 * i + 5 * j) % 7)};
  };
  Soup soup;
  for (unsigned i = 0; i < side; ++i)
    for (unsigned j = 0; j < side; ++j) {
      soup.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      soup.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return soup;
}

std::vector<OpenModel> open_models() {
  Random random(41);
  std::vector<OpenModel> models;
  const Soup cube = box({0, 0, 0}, {1, 1, 1});
  OpenModel lidless{"a cube less a face", {}, {}};
  for (const Corners& face : cube) {
    const bool lid = face[0].z == 1 && face[1].z == 1 && face[2].z == 1;
    (lid ? lidless.missing : lidless.present).push_back(face);
  }
  models.push_back(lidless);
  models.push_back({"twice", lidless.present + lidless.present, lidless.missing});
  models.push_back({"inside out", inside_out(lidless.present), lidless.missing});
  models.push_back(less("a ball less a face", ball(3), 1, false, random));
  models.push_back(less("a ball less scattered faces", ball(3), 40, false, random));
  models.push_back(less("a ball less a cluster", ball(3), 60, true, random));
  models.push_back(
      less("shells", ball(3) + scaled(ball(2), 0.5) + scaled(ball(2), 0.75), 30, false, random));
  OpenModel flipped = less("a flipped patch", ball(3), 25, true, random);
  flipped.present = flipped.present + inside_out(flipped.missing);
  models.push_back(flipped);
  models.push_back({"a strip of one side", moebius(40), {}});
  models.push_back({"a terrain", terrain(9), {}});
  models.push_back({"two terrains", terrain(6) + translated(terrain(6), {0.5, 0.25, 1}), {}});
  return models;
}

double one_ulp_beside(Random& random, double value) {
  const std::uint64_t way = random.below(3);
  if (way == 0) return value;
  if (value == 0) return way == 1 ? 0x1p-60 : -0x1p-60;
  return std::nextafter(value, way == 1 ? 1e9 : -1e9);
}

/// Subnormal coordinates are rounded away by the model frame.
Vec3 without_subnormals(const Vec3& point) {
  const auto flushed = [](double value) { return std::fabs(value) < 1e-300 ? 0 : value; };
  return {flushed(point.x), flushed(point.y), flushed(point.z)};
}

/// A point on a triangle, or an ulp beside it: inside, on an edge, or a corner.
Vec3 at_triangle(Random& random, const Corners& triangle) {
  constexpr double kShares[] = {0, 0.25, 0.5, 0.75};
  const double u = kShares[random.below(4)], v = (1 - u) * kShares[random.below(4)];
  const auto mix = [&](double a, double b, double c) {
    return one_ulp_beside(random, a + u * (b - a) + v * (c - a));
  };
  const auto& [a, b, c] = triangle;
  return {mix(a.x, b.x, c.x), mix(a.y, b.y, c.y), mix(a.z, b.z, c.z)};
}

class OpenSides {
 public:
  OpenSides(const OpenModel& model, Random& random)
      : model_(model), built_(model.present, {4096}), random_(random) {}

  Vec3 query() {
    switch (random_.below(4)) {
      case 0:
        return without_subnormals(nasty_query(random_, model_.present, 1));
      case 1:
        return at_triangle(random_, model_.present[random_.below(model_.present.size())]);
      case 2:
        if (!model_.missing.empty())
          return at_triangle(random_, model_.missing[random_.below(model_.missing.size())]);
        [[fallthrough]];
      default:
        return {random_.between(-1.5, 2), random_.between(-1.5, 2), random_.between(-1.5, 2)};
    }
  }

  void check(const Vec3& query) {
    const OpenWinding w = open_winding(query, model_.present);
    const long double beyond = std::fabs(w.value) - 0.5L;
    const bool is_open = std::fabs(beyond) < 0x1p-45L * static_cast<long double>(size());
    const Side truth = w.on_surface ? Side::kOnSurface
                       : beyond > 0 ? Side::kInside
                                    : Side::kOutside;
    SCOPED_TRACE(testing::Message()
                 << model_.name << " at " << std::hexfloat << query.x << ' ' << query.y << ' '
                 << query.z << ", w " << static_cast<double>(w.value));
    const Containment alone = built_.probe().contains(query);
    const ClosestPoint nearest = built_.probe().closest_point(query);
    for (const auto& [side, status] :
         {std::pair(alone.side, alone.status), std::pair(nearest.side, nearest.status)}) {
      if (side == Side::kUnknown) {
        EXPECT_TRUE(is_open && !w.on_surface);
        EXPECT_EQ(status, Status::kDegraded);
      } else {
        EXPECT_EQ(status, Status::kExact);
        if (!is_open || w.on_surface) {
          EXPECT_EQ(side, truth);
        }
      }
    }
    const QueryOptions limited{.max_work = static_cast<std::uint32_t>(1 + random_.below(100))};
    const Containment some = built_.probe().contains(query, limited);
    EXPECT_EQ(some.side == Side::kUnknown, some.status == Status::kDegraded);
    if (some.side != Side::kUnknown && (!is_open || w.on_surface)) {
      EXPECT_EQ(some.side, truth);
    }
  }

 private:
  std::size_t size() const { return model_.present.size(); }

  const OpenModel& model_;
  BuiltModel built_;
  Random& random_;
};

// 101,200 queries, at holes and caps among other places.
TEST(OpenSides, AreThoseOfTheSumOfSolidAngles) {
  for (const OpenModel& model : open_models()) {
    Random random(7);
    OpenSides sides(model, random);
    for (int i = 0; i < static_cast<int>(9200 * test_effort()) && !testing::Test::HasFailure(); ++i)
      sides.check(sides.query());
  }
}

}  // namespace
}  // namespace planetree::oracle
