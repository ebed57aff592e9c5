#include "query/answer/model_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

namespace planetree::query {
namespace {

storage::FileHeader header_with_strays() {
  storage::FileHeader header{};
  header.page_bytes = 4096;
  header.page_count = 3;
  header.model.mask_page_count = 1;
  header.model.scale_exponent = 1;
  std::fill(std::begin(header.model.box_lower), std::end(header.model.box_lower), -100.0);
  std::fill(std::begin(header.model.box_upper), std::end(header.model.box_upper), 100.0);
  std::fill(std::begin(header.model.core_upper), std::end(header.model.core_upper), 0.75);
  header.model.stray_count = 2;
  header.model.stray_edge = 0x1p10;
  return header;
}

constexpr OpenLayers kSides{kDistanceLayer | kSideLayer};

TEST(ModelGeometry, HasTheMaskAtTheCore) {
  const ModelGeometry geometry(header_with_strays(), kSides);
  EXPECT_EQ(geometry.tree.box_lower.x(), -200);
  EXPECT_EQ(geometry.tree.core_lower.x(), 0);
  EXPECT_EQ(geometry.tree.core_upper.x(), 1.5);
  EXPECT_EQ(geometry.mask.lower.x(), 0);
  EXPECT_TRUE(geometry.mask.reaches({2, 2, 2}));
  EXPECT_FALSE(geometry.mask.reaches({2.1, 1, 1}));
  EXPECT_FALSE(geometry.mask.reaches({1, -0.1, 1}));
}

TEST(ModelGeometry, BoundsTheErrorOfStrays) {
  storage::FileHeader header = header_with_strays();
  EXPECT_EQ(ModelGeometry(header, kSides).tree.bound_slack, octree::bound_slack(0x1p10));
  EXPECT_GT(ModelGeometry(header, kSides).tree.bound_slack, octree::kAbsoluteBoundSlack);
  header.model.stray_count = 0;
  header.model.stray_edge = 0;
  EXPECT_EQ(ModelGeometry(header, kSides).tree.bound_slack, octree::kAbsoluteBoundSlack);
  EXPECT_TRUE(ModelGeometry(header, kSides).mask.reaches({9, 9, 9}));
}

}  // namespace
}  // namespace planetree::query
