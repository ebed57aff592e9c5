#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/octree/page/mask_corruptions.h"

namespace planetree::octree {
namespace {

// Index of the first entry of a list that has more than one block.
std::size_t first_list_of_several(const RawMaskPage& page) {
  std::size_t at = 0;
  for (const std::uint8_t count : page.block_counts) {
    if (count > 1) return at;
    at += count;
  }
  ADD_FAILURE() << "no list of the sample suits";
  return 0;
}

// Gives all lists the maximum length.
void lengthen_lists(RawMaskPage& page) {
  std::ranges::fill(page.block_counts, std::uint8_t{kMaxListed});
  const std::size_t blocks = page.block_counts.size() * kMaxListed;
  page.head.block_link_count = static_cast<std::uint16_t>(blocks);
  page.block_octants.resize(blocks, 1);
  page.block_pages.resize(blocks);
  page.block_numbers.resize(blocks);
}

void grow(std::uint16_t& count, int by) { count = static_cast<std::uint16_t>(count + by); }

using P = RawMaskPage;
using F = PageInfo;

}  // namespace

std::vector<MaskCorruption> mask_list_corruptions() {
  return {
      {"its records do not fit a page", [](P& p, F&) { lengthen_lists(p); }},
      {"a corner's winding number is out of range", [](P& p, F&) { p.least[0] = kUncounted; }},
      {"a corner's winding number is out of range", [](P& p, F&) { p.least[0] = kListedTag; }},
      {"a corner's winding number is out of range", [](P& p, F&) { p.least.back() = 127; }},
      {"a list's count of blocks is out of range", [](P& p, F&) { p.block_counts[0] = 0; }},
      {"a list's count of blocks is out of range", [](P& p, F&) { p.block_counts[0] = 17; }},
      {"a list's count of blocks is out of range", [](P& p, F&) { p.block_counts.back() = 0xff; }},
      {"its lists do not add up",
       [](P& p, F&) {
         const auto at = std::ranges::find_if(p.block_counts, [](auto n) { return n > 1; });
         ASSERT_NE(at, p.block_counts.end());
         --*at;
       }},
      {"its lists do not add up",
       [](P& p, F&) {
         grow(p.head.block_link_count, 1);
         p.block_octants.push_back(1);
         p.block_pages.push_back(0xffffffff);
         p.block_numbers.push_back(0);
       }},
      {"a slab's direction is out of range", [](P& p, F&) { p.slab_directions[0] |= 3; }},
      {"a slab's direction is out of range",
       [](P& p, F&) { p.slab_directions.back() = CellSlab::make_direction(0, 33, 0); }},
      {"a slab's direction is out of range",
       [](P& p, F&) { p.slab_directions[0] = CellSlab::make_direction(1, -32, 33); }},
      {"a slab's planes are the wrong way round",
       [](P& p, F&) {
         p.slab_lowers[0] = 8;
         p.slab_uppers[0] = 7;
       }},
      {"a listed block has no octant", [](P& p, F&) { p.block_octants[0] = 0; }},
      {"a listed block has no octant", [](P& p, F&) { p.block_octants.back() = 0; }},
      {"a list has a link that leads to no block",
       [](P& p, F& f) { p.block_pages.back() = f.tree_pages; }},
      {"a list has a link that leads to no block",
       [](P& p, F&) { p.block_pages.back() = 0xffffffff; }},
      {"a list has a link that leads to no block",
       [](P& p, F& f) {
         p.block_numbers[0] = static_cast<std::uint16_t>(max_page_blocks(f.page_bytes));
       }},
      {"a list has a link that leads to no block",
       [](P& p, F&) { p.block_numbers.back() = 0xffff; }},
      {"the blocks of a list are not in order",
       [](P& p, F&) {
         const std::size_t at = first_list_of_several(p);
         std::swap(p.block_pages[at], p.block_pages[at + 1]);
         std::swap(p.block_numbers[at], p.block_numbers[at + 1]);
       }},
      {"the blocks of a list are not in order",
       [](P& p, F&) {
         const std::size_t at = first_list_of_several(p);
         p.block_pages[at + 1] = p.block_pages[at];
         p.block_numbers[at + 1] = p.block_numbers[at];
       }},
  };
}

}  // namespace planetree::octree
