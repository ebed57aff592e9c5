#include <gtest/gtest.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/tools/check/mask_check_fixture.h"

// Issues that verify finds in the lists of blocks of mask cells.
namespace planetree::tools {
namespace {

class FileCheckOfLists : public FileCheckOfMasks {};

TEST_F(FileCheckOfLists, FindsBlocksThatAreNotListed) {
  // One octant of one block is missing.
  for (const bool first : {true, false})
    expect_found("MASK_BLOCKS", has_lists, [&](RawMaskPage& page) {
      std::uint8_t& octants = first ? page.block_octants.front() : page.block_octants.back();
      // Clears the lowest bit; if it is the only one, sets another instead.
      const auto left = static_cast<std::uint8_t>(octants & (octants - 1));
      octants = left != 0 ? left : std::rotl(octants, 1);
    });
  // One block of a longer list is missing.
  const auto has_long_list = [](const RawMaskPage& page) {
    return page.head.listed_count > 0 && page.block_counts[0] > 1;
  };
  expect_found("MASK_BLOCKS", has_long_list, [](RawMaskPage& page) {
    --page.block_counts[0];
    --page.head.block_link_count;
    page.block_pages.erase(page.block_pages.begin());
    page.block_numbers.erase(page.block_numbers.begin());
    page.block_octants.erase(page.block_octants.begin());
  });
}

TEST_F(FileCheckOfLists, FindsLinksInListsThatLeadToNoBlock) {
  // No page of 4 KiB has as many blocks as the format would allow.
  expect_found("MASK_BLOCKS", has_lists, [](RawMaskPage& page) {
    ++page.block_counts[page.block_counts.size() - 1];
    ++page.head.block_link_count;
    page.block_pages.push_back(page.block_pages.back());
    page.block_numbers.push_back(15);
    page.block_octants.push_back(1);
  });
}

TEST_F(FileCheckOfLists, FindsSlabsThatDoNotContainTheSurface) {
  // Indices of slabs thicker than one step for which has(page, i) holds.
  const auto slabs = [](const RawMaskPage& page, const auto& has) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < page.slab_uppers.size(); ++i)
      if (page.slab_uppers[i] > page.slab_lowers[i] + 1 && has(page, i)) found.push_back(i);
    return found;
  };
  const auto with_upper = [&](const RawMaskPage& page) {
    return slabs(page, [](const RawMaskPage& of, std::size_t i) {
      return of.slab_uppers[i] != octree::CellSlab::kNoUpper;
    });
  };
  const auto with_lower = [&](const RawMaskPage& page) {
    return slabs(page, [](const RawMaskPage& of, std::size_t i) {
      return of.slab_lowers[i] != octree::CellSlab::kNoLower;
    });
  };
  const auto has_upper = [&](const RawMaskPage& page) { return !with_upper(page).empty(); };
  const auto has_lower = [&](const RawMaskPage& page) { return !with_lower(page).empty(); };
  expect_found("MASK_SLAB", has_upper, [&](RawMaskPage& page) {
    const std::size_t first = with_upper(page).front();
    page.slab_uppers[first] = page.slab_lowers[first];
  });
  expect_found("MASK_SLAB", has_lower, [&](RawMaskPage& page) {
    const std::size_t last = with_lower(page).back();
    page.slab_lowers[last] = page.slab_uppers[last];
  });
}

TEST_F(FileCheckOfLists, AllowsWiderSlabs) {
  const auto widen = [](RawMaskPage& page) {
    for (std::uint8_t& lower : page.slab_lowers) lower = static_cast<std::uint8_t>(lower / 2);
    for (std::uint8_t& upper : page.slab_uppers) upper = octree::CellSlab::kNoUpper;
  };
  EXPECT_EQ(codes_of_change(boxes(), has_lists, widen), Codes{});
}

TEST_F(FileCheckOfLists, AllowsOctantsThatNoTriangleTouches) {
  const auto add = [](RawMaskPage& page) {
    page.block_octants.assign(page.block_octants.size(), 0xff);
  };
  EXPECT_EQ(codes_of_change(boxes(), has_lists, add), Codes{});
}

}  // namespace
}  // namespace planetree::tools
