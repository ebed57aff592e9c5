#include "tools/slice/slice_plane.h"

#include <gtest/gtest.h>

namespace planetree::tools {
namespace {

TEST(SlicePlane, ReadsNumbersAndShares) {
  ModelInfo info;
  info.core_lower = {-1, -2, -4};
  info.core_upper = {1, 2, 0};
  EXPECT_EQ(SlicePlane::parse("z=50%")->coordinate(info), -2);
  EXPECT_EQ(SlicePlane::parse("Y=0%")->coordinate(info), -2);
  EXPECT_EQ(SlicePlane::parse("x=-1.5e1")->coordinate(info), -15);
  for (const char* text : {"", "z", "z=", "w=1", "z=1x", "z=%", "z=nan", "z=1e999", "zz=1"})
    EXPECT_FALSE(SlicePlane::parse(text)) << text;
}

TEST(SlicePlane, ComplainsBesideTheCore) {
  ModelInfo info;
  info.core_lower = {-1, -2, -4};
  info.core_upper = {1, 2, 0};
  const auto complaint = [&info](const char* text) {
    return SlicePlane::parse(text)->complaint(info);
  };
  for (const char* text : {"z=-4", "z=0", "z=0%", "z=100%", "x=0.5"})
    EXPECT_EQ(complaint(text), "") << text;
  EXPECT_EQ(complaint("z=0.5"),
            "the plane z=0.5 is outside of the model's box, where z is from -4 to 0; give a z "
            "between them to cut the surface");
  EXPECT_TRUE(complaint("y=150%").starts_with("the plane y=150%, y=4, is outside of "))
      << complaint("y=150%");
  EXPECT_NE(complaint("x=-1.5"), "");
  info.strays = 2;
  EXPECT_NE(complaint("x=-1.5").find("the box of all triangles but 2 strays"), std::string::npos);
}

}  // namespace
}  // namespace planetree::tools
