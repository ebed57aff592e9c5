#include "tools/tune/page_size_replay.h"

#include <gtest/gtest.h>

#include "octree/geometry/octcode.h"
#include "tests/tools/tune/made_accesses.h"

namespace planetree::tools {
namespace {

using Event = PageAccess::Event;

constexpr Vec3 kLower{10, 10, 10}, kUpper{11.5, 11, 11};  // the octree's edge is 2

/// A lookup of the page of a cell: page 4 + its place among those of level 2 in Morton order.
PageAccess lookup_in(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  const std::uint64_t code = octree::morton_code(x << 17, y << 17, z << 17);
  PageAccess access = lookup(0, 4 + static_cast<std::uint32_t>(code >> 51), Event::kHit);
  access.octcode = octree::octcode_of_prefix(code, 6);
  return access;
}
PageAccess motion_to(double x, double y, double z) {
  PageAccess access = lookup(0, 0, Event::kMotion);
  access.position = {x, y, z};
  return access;
}
std::size_t pages_of(const PageSizeReplay& replay) { return replay.references().pages().size(); }

TEST(PageSizeReplay, TakesNeighboursForOneLargerPage) {
  PageSizeReplay larger(1 << 16, 1 << 18, kLower, kUpper);
  PageSizeReplay same(1 << 16, 1 << 16, kLower, kUpper);
  for (std::uint32_t x = 0; x < 4; ++x)
    for (std::uint32_t y = 0; y < 2; ++y)
      for (PageSizeReplay* replay : {&larger, &same}) replay->add(lookup_in(x, y, 0));
  EXPECT_EQ(pages_of(same), 8u);
  EXPECT_EQ(pages_of(larger), 2u);
  EXPECT_EQ(larger.references().lookups(), 8u);
  larger.add(lookup(0, 3, Event::kHit));
  EXPECT_EQ(pages_of(larger), 2u) << "the first pages are in one with the root";
  EXPECT_EQ(larger.references().lookups(), 9u);
}

TEST(PageSizeReplay, TakesThePartNearTheProbeForASmallerPage) {
  PageSizeReplay smaller(1 << 16, 1 << 14, kLower, kUpper);
  // Cell (1, 0, 0) of level 2 is from 10.5 to 11 in x, and from 10 to 10.5 in y and z.
  const auto number_near = [&](double x, double y, double z) {
    smaller.add(motion_to(x, y, z));
    smaller.add(lookup_in(1, 0, 0));
    const References references = smaller.references();
    return references.stored().back();
  };
  const auto first = number_near(10.6, 10.1, 10.1);
  EXPECT_EQ(number_near(10.7, 10.2, 10.2), first);
  const auto beside = number_near(10.8, 10.1, 10.1);
  EXPECT_NE(beside, first);
  EXPECT_EQ(number_near(99, 10.1, -99), beside) << "outside of the page: its nearest part";
  EXPECT_NE(number_near(10.8, 10.3, 10.1), beside);
  EXPECT_EQ(pages_of(smaller), 3u);
}

TEST(PageSizeReplay, KeepsTiersTheRootAndTheOpening) {
  PageSizeReplay larger(1 << 16, 1 << 18, kLower, kUpper);
  larger.add(own(PageAccess::Query::kOpen, 0, Event::kHit));
  PageAccess upper = lookup_in(0, 0, 0);
  upper.query_kind = PageAccess::Query::kOpen;
  larger.add(upper);
  upper.event = Event::kInstalled;
  upper.is_upper = true;
  larger.add(upper);
  larger.add(lookup_in(3, 0, 0));
  larger.add(lookup(0, 0, Event::kHit));
  const References references = larger.references();
  EXPECT_EQ(references.opening(), 1u);
  EXPECT_EQ(references.lookups(), 2u);
  ASSERT_EQ(references.pages().size(), 2u);
  EXPECT_EQ(references.pages()[0].tier, cache::PageTier::kUpper);
  EXPECT_EQ(references.pages()[1].tier, cache::PageTier::kLower);
  EXPECT_EQ(references.root_tier(), cache::PageTier::kUpper);
}

}  // namespace
}  // namespace planetree::tools
