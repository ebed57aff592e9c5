// Checks "Region" in the sample of a region, as the independent reader decodes it, against the
// sample of the whole mesh.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <set>

#include "planetree/planetree.h"
#include "tests/golden/samples.h"
#include "tests/golden/spec_mask.h"
#include "tests/golden/spec_tree.h"
#include "tests/golden/spec_vector.h"

namespace planetree::golden {
namespace {

class SpecRegion : public testing::Test {
 protected:
  SpecRegion()
      : file_(read_file(region_sample().ptree_path())),
        tree_(file_),
        mask_(file_),
        whole_(SpecFile(read_file(boxes_sample().ptree_path()))),
        all_(whole_.triangles(whole_.header().root_link())) {}

  const SpecHeader& header() const { return file_.header(); }

  // The winding number, or nothing if the point is so close to the surface that rounding decides.
  std::optional<int> winding(const SpecPoint& point) const {
    const double number = winding_number(all_, point);
    if (whole_.nearest(point).distance < 1e-9) return std::nullopt;
    return static_cast<int>(std::round(number));
  }
  bool is_in_region(const SpecPoint& lower, const SpecPoint& upper) const {
    bool meets = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      meets = meets && lower[axis] <= header().wall_upper[axis] &&
              header().wall_lower[axis] <= upper[axis];
    return meets;
  }
  SpecPoint random_point() {
    SpecPoint point{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double share = static_cast<double>(random_() >> 11) * 0x1p-53;
      point[axis] = std::ldexp(
          header().box_lower[axis] + share * (header().box_upper[axis] - header().box_lower[axis]),
          header().scale_exponent);
      if (random_() % 4 != 0) point[axis] = clamped(point[axis], share, axis);
    }
    return point;
  }

  SpecFile file_;
  SpecTree tree_;
  SpecMask mask_;
  SpecTree whole_;
  std::vector<SpecTriangle> all_;
  std::mt19937_64 random_{5};

 private:
  double clamped(double value, double share, std::size_t axis) const {
    const double lower = header().wall_lower[axis], upper = header().wall_upper[axis];
    return std::isfinite(lower) && std::isfinite(upper) ? lower + share * (upper - lower)
                                                        : std::clamp(value, lower, upper);
  }
};

TEST_F(SpecRegion, MatchesTheBuildersOutput) {
  const Sample& sample = region_sample();
  EXPECT_EQ(build_bytes(sample.mesh_path(), sample.page_bytes, 2, sample.box),
            read_file(sample.ptree_path()))
      << "if pages changed on purpose, or LZ4 did, see the top of samples_test.cpp";
}

TEST_F(SpecRegion, HasTheHeaderOfTheWhole) {
  const SpecHeader &part = header(), &whole = whole_.header();
  EXPECT_EQ(part.input_triangles, whole.triangle_count);
  EXPECT_LT(part.triangle_count, whole.triangle_count);
  EXPECT_EQ(part.box_lower, whole.box_lower);
  EXPECT_EQ(part.box_upper, whole.box_upper);
  EXPECT_EQ(part.centre, whole.centre);
  EXPECT_EQ(part.scale_exponent, whole.scale_exponent);
  EXPECT_EQ(part.open(), whole.open());
  EXPECT_EQ(whole.input_triangles, 0u);
}

TEST_F(SpecRegion, HoldsTheTrianglesThatTouchIt) {
  std::map<std::uint64_t, std::array<SpecPoint, 3>> kept;
  for (const SpecTriangle& triangle : tree_.triangles(header().root_link()))
    kept[triangle.id] = triangle.corners;
  EXPECT_EQ(kept.size(), header().triangle_count);
  EXPECT_EQ(kept.begin()->first, header().sample_triangle);
  EXPECT_EQ(kept.begin()->second[0], header().sample);
  for (const SpecTriangle& triangle : all_) {
    bool has_corner = false;
    SpecPoint lower = triangle.corners[0], upper = lower;
    for (const SpecPoint& corner : triangle.corners) {
      has_corner = has_corner || is_in_region(corner, corner);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], corner[axis]);
        upper[axis] = std::max(upper[axis], corner[axis]);
      }
    }
    if (has_corner) {
      EXPECT_TRUE(kept.contains(triangle.id)) << triangle.id;
    }
    if (kept.contains(triangle.id)) {
      EXPECT_TRUE(is_in_region(lower, upper)) << triangle.id;
      EXPECT_EQ(kept[triangle.id], triangle.corners);
    }
  }
}

TEST_F(SpecRegion, HasTheWindingNumbersOfTheWhole) {
  std::size_t coloured_cells = 0, corners = 0, beyond = 0;
  mask_.each_grey([&](const SpecCell& cell, const SpecMaskRecord& record) {
    for (unsigned i = 0; i < 8; ++i) {
      if (record.is_node() && (record.grey >> i & 1) == 0) {
        const SpecCell octant = cell.octant(i);
        const SpecPoint lower = mask_.corner(octant, 0), upper = mask_.corner(octant, 7);
        const SpecPoint middle = {(lower[0] + upper[0]) / 2, (lower[1] + upper[1]) / 2,
                                  (lower[2] + upper[2]) / 2};
        const bool flat = lower[0] == upper[0] || lower[1] == upper[1] || lower[2] == upper[2];
        beyond += flat;
        if (flat) continue;
        const auto number = winding(middle);
        ASSERT_TRUE(number);
        EXPECT_EQ(*number > 0, (record.black >> i & 1) != 0);
        EXPECT_EQ(*number < 0, (record.inverted >> i & 1) != 0);
        ++coloured_cells;
      } else if (record.has_corners()) {
        const auto number = winding(mask_.corner(cell, i));
        if (!number) continue;
        EXPECT_EQ(record.corners[i], *number);
        ++corners;
      }
    }
  });
  EXPECT_GT(coloured_cells, 0u);
  EXPECT_GT(corners, 0u);
  EXPECT_GT(beyond, 0u);
  const auto number = winding(mask_.corner({}, 0));
  ASSERT_TRUE(number);
  EXPECT_EQ(header().region_winding, *number);
  EXPECT_NE(*number, 0);
}

// nearest() of "Nearest triangle": bounds that the part gives for the whole.
TEST_F(SpecRegion, BoundsTheDistanceToTheWhole) {
  const auto model = Model::open(region_sample().ptree_path());
  ASSERT_TRUE(model);
  auto probe = Probe::create(*model);
  ASSERT_TRUE(probe);
  std::map<Status, int> seen;
  for (int i = 0; i < 2000; ++i) {
    const SpecPoint point = random_point();
    double wall = INFINITY;
    for (std::size_t axis = 0; axis < 3; ++axis)
      wall = std::min(
          {wall, point[axis] - header().wall_lower[axis], header().wall_upper[axis] - point[axis]});
    const SpecNearest part = tree_.nearest(point), whole = whole_.nearest(point);
    const int back = -header().scale_exponent;
    const ClosestPoint answer = probe->closest_point(
        {std::ldexp(point[0], back), std::ldexp(point[1], back), std::ldexp(point[2], back)});
    ++seen[answer.status];
    if (std::fabs(part.distance - wall) < 1e-9) continue;
    EXPECT_EQ(answer.status, part.distance < wall ? Status::kExact : Status::kDegraded);
    if (part.distance < wall) {
      EXPECT_EQ(part.triangle, whole.triangle);
    } else {
      EXPECT_LE(std::max(0.0, wall), whole.distance);
      EXPECT_NEAR(std::ldexp(answer.lower, -back), std::max(0.0, wall), 1e-9);
    }
    EXPECT_EQ(answer.side == Side::kUnknown, wall < 0);
    if (const auto number = winding(point); number && wall >= 0) {
      EXPECT_EQ(answer.side, *number != 0 ? Side::kInside : Side::kOutside);
    }
  }
  EXPECT_GT(seen[Status::kExact], 100);
  EXPECT_GT(seen[Status::kDegraded], 100);
}

}  // namespace
}  // namespace planetree::golden
