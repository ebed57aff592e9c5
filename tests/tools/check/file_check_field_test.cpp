#include <gtest/gtest.h>

#include <cstring>

#include "octree/field/field_page.h"
#include "tests/tools/check/mask_check_fixture.h"

// Issues that verify finds in field pages.
namespace planetree::tools {
namespace {

class FileCheckOfFields : public FileCheckOfMasks {};

TEST_F(FileCheckOfFields, FindsPointsThatAreNotNearest) {
  // The first point is moved by a few quanta along x. The points after it move along.
  Forgery forgery;
  forgery.field = [](std::uint32_t, std::vector<std::byte>& raw) {
    raw[sizeof(octree::FieldPageHead)] ^= std::byte{8};
  };
  EXPECT_EQ(codes_of(check_forgery(boxes(), forgery, true)), Codes{"FIELD"});
  EXPECT_EQ(codes_of(check_forgery(boxes(), forgery, false)), Codes{});
}

TEST_F(FileCheckOfFields, FindsPagesWithBadStructure) {
  Forgery forgery;
  forgery.field = [](std::uint32_t, std::vector<std::byte>& raw) {
    raw[offsetof(octree::FieldPageHead, reserved)] = std::byte{1};
  };
  EXPECT_EQ(codes_of(check_forgery(boxes(), forgery, false)), Codes{"PAGE_STRUCTURE"});
}

}  // namespace
}  // namespace planetree::tools
