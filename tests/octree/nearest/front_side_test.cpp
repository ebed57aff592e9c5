#include "octree/nearest/front_side.h"

#include <gtest/gtest.h>

#include "octree/geometry/angles.h"
#include "octree/geometry/work_limit.h"

namespace planetree::octree {
namespace {

constexpr std::uint64_t kWork = 100000;

// Two faces that are mirror images in y, so that their heights over a query cancel if its z is 0.
Front front_of_mirrored_faces(const Point& query, bool by_angle, std::uint64_t max_work = kWork,
                              bool reversed = false) {
  const Triangle left{Point(0, 0, 0), Point(1, 0, 0.25), Point(0.3, 1, 0.7)};
  const Triangle right{Point(0, 0, 0), Point(0.3, -1, 0.7), Point(1, 0, 0.25)};
  const double angle =
      by_angle ? angle_between(left[1] - left[0], left[2] - left[0]) : 1;  // of both
  std::uint64_t units = 0;
  WorkLimit limit(units, max_work);
  FrontSide side(query);
  side.begin(by_angle);
  side.add(reversed ? right : left, 0, 4, angle, limit);
  side.add(reversed ? left : right, 0, 7, angle, limit);
  return side.front(false, limit);
}

TEST(FrontSide, ExactSignsOfAllFacesDecide) {
  for (const bool by_angle : {false, true}) {
    EXPECT_EQ(front_of_mirrored_faces({0, 0, 1e-300}, by_angle), Front::kInFront);
    EXPECT_EQ(front_of_mirrored_faces({0, 0, -1e-300}, by_angle), Front::kBehind);
    EXPECT_EQ(front_of_mirrored_faces({0, 0, 0}, by_angle), Front::kLevel);
  }
}

TEST(FrontSide, DoubleThenQuadThenNothingDecidesOppositeSigns) {
  for (const bool by_angle : {false, true})
    for (const bool reversed : {false, true})
      for (const double y : {1.0, -0.125})
        for (const double z : {1e-3, 1e-10, 1e-14, 1e-20, 1e-26}) {
          EXPECT_EQ(front_of_mirrored_faces({0, y, z}, by_angle, kWork, reversed), Front::kInFront)
              << z;
          EXPECT_EQ(front_of_mirrored_faces({0, y, -z}, by_angle, kWork, reversed), Front::kBehind)
              << z;
        }
  EXPECT_EQ(front_of_mirrored_faces({0, 1, 1e-32}, true), Front::kUnknown);
  EXPECT_EQ(front_of_mirrored_faces({0, 1, 0}, true), Front::kUnknown);
}

TEST(FrontSide, WideNumbersAreChargedOrRefused) {
  EXPECT_EQ(front_of_mirrored_faces({0, 1, 1e-20}, true, 2 * WorkUnits::kWideCornerHeight),
            Front::kInFront);
  EXPECT_EQ(front_of_mirrored_faces({0, 1, 1e-20}, true, 2 * WorkUnits::kWideCornerHeight - 1),
            Front::kUnknown);
  EXPECT_EQ(front_of_mirrored_faces({0, 1, 1e-3}, true, 0), Front::kInFront);
}

// In double the number of faces does not matter; with 113 bits it does.
TEST(FrontSide, ManyFaces) {
  const Triangle left{Point(0, 0, 0), Point(1, 0, 0.25), Point(0.3, 1, 0.7)};
  const Triangle right{Point(0, 0, 0), Point(0.3, -1, 0.7), Point(1, 0, 0.25)};
  const auto front = [&](unsigned pairs, double z) {
    std::uint64_t units = 0;
    WorkLimit limit(units, kWork);
    const Point query(0, 1, z);
    FrontSide side(query);
    side.begin(false);
    for (unsigned i = 0; i < pairs; ++i) {
      side.add(left, 0, 2 * i, 1, limit);
      side.add(right, 0, 2 * i + 1, 1, limit);
    }
    return side.front(false, limit);
  };
  EXPECT_EQ(front(16, 1e-20), Front::kInFront);
  EXPECT_EQ(front(17, 1e-20), Front::kUnknown);
  EXPECT_EQ(front(5000, 1e-6), Front::kInFront);
  EXPECT_EQ(front(5000, -1e-6), Front::kBehind);
}

TEST(FrontSide, TheFaceOfLeastIndexDecidesACancelledSum) {
  std::uint64_t units = 0;
  WorkLimit limit(units, kWork);
  const Point query(0.2, 0.2, 1);
  FrontSide side(query);
  const Triangle up{Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
  const Triangle down{up[0], up[2], up[1]};
  for (const std::uint64_t up_index : {std::uint64_t{1}, std::uint64_t{9}}) {
    side.begin(true);
    side.add(down, 0, 5, 1, limit);
    side.add(up, 0, up_index, 1, limit);
    EXPECT_EQ(side.front(true, limit), up_index < 5 ? Front::kInFront : Front::kBehind);
  }
  side.begin(true);
  EXPECT_EQ(side.front(false, limit), Front::kUnknown);
}

}  // namespace
}  // namespace planetree::octree
