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

}  // namespace
}  // namespace planetree::tools
