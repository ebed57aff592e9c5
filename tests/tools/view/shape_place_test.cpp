#include "tools/view/shape_place.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace planetree::tools {
namespace {

constexpr double kHalfRoot = 0.70710678118654752;

TEST(ShapePlace, LeavesTheViewOfAFileInItsOwnFrame) {
  ShapeView view{5, true, {0.1, -1e300, 3}, {1, 2, 3}, 0.5};
  EXPECT_TRUE(ShapePlace().view_from(view) == view);
  EXPECT_EQ(ShapePlace().scale(), 1);
}

TEST(ShapePlace, TurnsMovesAndScalesTheView) {
  const Pose quarter_turn{{kHalfRoot, 0, 0, kHalfRoot}, {10, 0, 0}};  // about z
  const ShapeFrame own{{1, 0, 0}, 2}, all{{8, 0, 0}, 4};
  const ShapePlace place(quarter_turn, own, all);
  EXPECT_EQ(place.scale(), 0.5);
  // The centre of the file is at (10, 1, 0) in the world.
  EXPECT_NEAR(place.offset().x, 0.5, 1e-15);
  EXPECT_NEAR(place.offset().y, 0.25, 1e-15);
  // The eye is at (10, 5, 0) in the world: 4 from the centre, along x of the file.
  const ShapeView view = place.view_from({7, true, {0.5, 1.25, 0}, {0, 2, 0}, 0.25});
  EXPECT_NEAR(view.eye.x, 2, 1e-14);
  EXPECT_NEAR(view.eye.y, 0, 1e-14);
  EXPECT_NEAR(view.look.x, 2, 1e-14);
  EXPECT_EQ(view.discs, 7u);
  EXPECT_EQ(view.cosine, 0.25);
}

TEST(ShapeFrame, HasABoxOfAnySizeNearTheOrigin) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  EXPECT_EQ(ShapeFrame::about({-1, 0, 0}, {2, 1, 1}).unit, 2);
  EXPECT_EQ(ShapeFrame::about({-1, 0, 0}, {2, 1, 1}).centre.x, 0.5);
  EXPECT_GT(ShapeFrame::about({3, 3, 3}, {3, 3, 3}).unit, 0);
  const ShapeFrame wide = ShapeFrame::about({-kLargest, 0, 0}, {kLargest, 1, 1});
  EXPECT_TRUE(std::isfinite(wide.unit) && std::isfinite(wide.centre.x));
}

}  // namespace
}  // namespace planetree::tools
