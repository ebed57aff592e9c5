#include "tests/octree/page/mask_corruptions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <limits>

namespace planetree::octree {
namespace {

constexpr auto kNode = static_cast<std::uint8_t>(MaskKind::kNode);
constexpr auto kNodeWithLink = static_cast<std::uint8_t>(MaskKind::kNodeWithLink);
constexpr auto kPlain = static_cast<std::uint8_t>(MaskKind::kPlainCorners);
constexpr auto kCorners = static_cast<std::uint8_t>(MaskKind::kCorners);
constexpr auto kSpecial = static_cast<std::uint8_t>(MaskKind::kSpecial);
constexpr auto kListed = static_cast<std::uint8_t>(MaskKind::kListed);

// Index of the first record of kind `kind`.
std::size_t record_of(const RawMaskPage& page, std::uint8_t kind) {
  const auto at = std::ranges::find(page.kinds, kind);
  EXPECT_NE(at, page.kinds.end()) << "no record of the sample suits";
  return static_cast<std::size_t>(at - page.kinds.begin());
}

// Index, among nodes, of the first node for which `holds`.
std::size_t find_node(const RawMaskPage& page,
                      const std::function<bool(std::size_t, std::uint8_t)>& holds) {
  std::size_t node = 0;
  for (const std::uint8_t kind : page.kinds) {
    if (kind > kNodeWithLink) continue;
    if (holds(node, kind)) return node;
    ++node;
  }
  ADD_FAILURE() << "no node of the sample suits";
  return 0;
}

// Kinds of the first nodes.
std::vector<std::uint8_t> nodes_before(const RawMaskPage& page, std::size_t node) {
  std::vector<std::uint8_t> kinds;
  for (const std::uint8_t kind : page.kinds)
    if (kind <= kNodeWithLink && kinds.size() < node) kinds.push_back(kind);
  return kinds;
}

std::size_t node_with_family(const RawMaskPage& page) {
  return find_node(
      page, [&](std::size_t i, std::uint8_t kind) { return kind == kNode && page.grey[i] != 0; });
}

// Index of the node whose family is the last of the page.
std::size_t last_with_family(const RawMaskPage& page) {
  std::size_t last = 0;
  find_node(page, [&](std::size_t i, std::uint8_t kind) {
    if (kind == kNode && page.grey[i] != 0) last = i;
    return i + 1 == page.grey.size();
  });
  return last;
}

// Index of the first corner of a record whose corner numbers are stored.
std::size_t first_stored_corner(const RawMaskPage& page) {
  std::size_t at = 0;
  while (at < page.corners.size() && page.corners[at] == kUncounted) at += 8;
  EXPECT_LT(at, page.corners.size()) << "no record of the sample suits";
  return at;
}

void grow(std::uint16_t& count, int by) { count = static_cast<std::uint16_t>(count + by); }

std::uint8_t lowest_bit(std::uint8_t bits) {
  return static_cast<std::uint8_t>(bits & -unsigned{bits});
}

using P = RawMaskPage;
using F = PageInfo;

std::vector<MaskCorruption> head_corruptions() {
  return {
      {"the page holds no record", [](P& p, F&) { p.head.record_count = 0; }},
      {"the page holds no record", [](P& p, F&) { p.head.root_count = 0; }},
      {"the count of roots does not fit",
       [](P& p, F&) { p.head.root_count = static_cast<std::uint16_t>(p.head.record_count + 1); }},
      {"the counts of records do not add up", [](P& p, F&) { grow(p.head.node_count, 1); }},
      {"the counts of records do not add up", [](P& p, F&) { grow(p.head.plain_count, -1); }},
      {"the counts of records do not add up", [](P& p, F&) { grow(p.head.corners_count, 1); }},
      {"the counts of records do not add up", [](P& p, F&) { grow(p.head.special_count, -1); }},
      {"the counts of records do not add up", [](P& p, F&) { grow(p.head.listed_count, 1); }},
      {"reserved bytes are not 0", [](P& p, F&) { p.head.reserved = 1; }},
      {"reserved bytes are not 0", [](P& p, F&) { p.head.reserved = 0x80000000; }},
      {"the count of links does not fit",
       [](P& p, F&) {
         p.head.page_link_count = static_cast<std::uint16_t>(p.head.node_count + 1);
       }},
      {"the page is shorter than its counts say", [](P& p, F&) { p.planes.pop_back(); }},
      {"the page is shorter than its counts say", [](P& p, F&) { p.planes.clear(); }},
      {"the page is shorter than its counts say", [](P& p, F&) { p.head.plane_count = 0xffff; }},
      {"the page is shorter than its counts say", [](P& p, F&) { p.least.pop_back(); }},
      {"the page is shorter than its counts say", [](P& p, F&) { p.block_pages.pop_back(); }},
      {"the page is longer than its counts say", [](P& p, F&) { p.planes.push_back(0); }},
      {"the page is longer than its counts say", [](P& p, F&) { p.block_octants.push_back(1); }},
      {"the page is longer than its counts say", [](P& p, F&) { grow(p.head.plane_count, -1); }},
      {"it is another page's bytes", [](P& p, F&) { ++p.head.page_number; }},
      {"it is another page's bytes", [](P&, F& f) { --f.page_number; }},
      {"its octcode is not the directory's", [](P&, F& f) { f.octcode ^= 1; }},
      {"its ordinal is not 0", [](P& p, F&) { ++p.head.ordinal; }},
      {"its records do not fit a page",
       [](P& p, F&) {
         p.head.plane_count = static_cast<std::uint16_t>(p.head.plane_count + 60);
         p.planes.resize(p.planes.size() + 9u * 60);
       }},
  };
}

std::vector<MaskCorruption> node_corruptions() {
  return {
      {"a record has no parent",
       [](P& p, F&) {
         // Only roots come before the first family.
         p.head.root_count = 1;
         p.kinds[0] = kPlain;
       }},
      {"a record is of unknown kind", [](P& p, F&) { p.kinds[0] = 6; }},
      {"a record is of unknown kind", [](P& p, F&) { p.kinds.back() = 0xff; }},
      {"an octant has two colours",
       [](P& p, F&) {
         const std::size_t at = node_with_family(p);
         p.black[at] = static_cast<std::uint8_t>(p.black[at] | lowest_bit(p.grey[at]));
       }},
      {"an octant has two colours",
       [](P& p, F&) {
         const std::size_t at = node_with_family(p);
         p.inverted[at] = static_cast<std::uint8_t>(p.inverted[at] | lowest_bit(p.grey[at]));
       }},
      {"an octant has two colours",
       [](P& p, F&) {
         const std::size_t at =
             find_node(p, [&](std::size_t i, std::uint8_t) { return p.black[i] != 0; });
         p.inverted[at] = lowest_bit(p.black[at]);
       }},
      {"an octant has two colours",
       [](P& p, F&) {
         const std::size_t at =
             find_node(p, [&](std::size_t i, std::uint8_t) { return p.grey[i] != 0xff; });
         p.leaf[at] = static_cast<std::uint8_t>(~p.grey[at]);
       }},
      {"the counts of records do not add up",
       [](P& p, F&) {
         const std::size_t last = last_with_family(p);
         ASSERT_GT(p.kinds.back(), kNodeWithLink);
         p.leaf[last] = static_cast<std::uint8_t>(p.leaf[last] & ~std::bit_floor(p.grey[last]));
         p.kinds.back() = kNode;
       }},
      {"the counts of records do not add up",
       [](P& p, F&) { p.kinds[record_of(p, kCorners)] = kPlain; }},
      {"the counts of records do not add up",
       [](P& p, F&) { p.kinds[record_of(p, kPlain)] = kCorners; }},
      {"the counts of records do not add up",
       [](P& p, F&) { p.kinds[record_of(p, kPlain)] = kSpecial; }},
      {"the counts of records do not add up",
       [](P& p, F&) { p.kinds[record_of(p, kPlain)] = kListed; }},
      {"the counts of records do not add up",
       [](P& p, F&) { p.kinds[record_of(p, kListed)] = kPlain; }},
      {"its families do not add up", [](P& p, F&) { p.head.root_count = p.head.record_count; }},
      {"a record has no parent",
       [](P& p, F&) {
         // Removes the last member of the last family.
         const std::size_t last = last_with_family(p);
         const auto kept = static_cast<std::uint8_t>(~std::bit_floor(p.grey[last]));
         p.grey[last] &= kept;
         p.leaf[last] &= kept;
       }},
      {"a record is not of the kind its parent says",
       [](P& p, F&) {
         const std::size_t at = node_with_family(p);
         p.leaf[at] = static_cast<std::uint8_t>(p.leaf[at] ^ lowest_bit(p.grey[at]));
       }},
      {"its page links do not add up",
       [](P& p, F&) {
         const std::size_t at =
             find_node(p, [](std::size_t, std::uint8_t kind) { return kind == kNodeWithLink; });
         p.grey[at] = p.leaf[at] = 0;
       }},
      {"its page links do not add up",
       [](P& p, F&) {
         grow(p.head.page_link_count, -1);
         p.linked_pages.pop_back();
         p.linked_records.pop_back();
       }},
      {"its page links do not add up",
       [](P& p, F&) {
         grow(p.head.page_link_count, 1);
         p.linked_pages.push_back(p.linked_pages[0]);
         p.linked_records.push_back(p.linked_records[0]);
       }},
      {"a link leads to a page that cannot be below it",
       [](P& p, F& f) { p.linked_pages[0] = f.page_number - f.first_page; }},
      {"a link leads to a page that cannot be below it",
       [](P& p, F& f) { p.linked_pages.back() = f.page_count; }},
      {"a link leads to a page that cannot be below it",
       [](P& p, F&) { p.linked_pages[0] = 0xffffffff; }},
      {"a link leads to a page that cannot be below it",
       [](P& p, F& f) {
         // The last record that a page can have, of a family of several.
         const std::size_t at = find_node(p, [&](std::size_t i, std::uint8_t kind) {
           return kind == kNodeWithLink && std::popcount(p.grey[i]) > 1;
         });
         const auto before = static_cast<std::size_t>(std::ranges::count_if(
             nodes_before(p, at), [](std::uint8_t kind) { return kind == kNodeWithLink; }));
         p.linked_records[before] =
             static_cast<std::uint16_t>(f.page_bytes / 8 - 1 - mask_head_slots(f.page_bytes));
       }},
      {"a link leads to a page that cannot be below it",
       [](P& p, F&) { p.linked_records.back() = 0xffff; }},
  };
}

std::vector<MaskCorruption> leaf_corruptions() {
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<MaskCorruption> all = {
      {"a corner's winding number is out of range",
       [](P& p, F&) { p.corners[first_stored_corner(p)] = kListedTag; }},
      {"a corner's winding number is out of range",
       [](P& p, F&) { p.corners[first_stored_corner(p) + 7] = kListedTag; }},
      {"a corner of a cell is not counted",
       [](P& p, F&) { p.corners[first_stored_corner(p) + 3] = kUncounted; }},
      {"a corner of a cell is not counted",
       [](P& p, F&) { std::fill_n(&p.corners[first_stored_corner(p)], 7, kUncounted); }},
      {"a special cell's planes are out of range", [](P& p, F&) { p.plane_counts[0] = 0; }},
      {"a special cell's planes are out of range", [](P& p, F&) { p.plane_counts.back() = 5; }},
      {"a special cell's planes are out of range", [](P& p, F&) { p.plane_counts[0] = 0xff; }},
      {"a special cell has no two sides", [](P& p, F&) { p.behind[0] = p.beyond[0]; }},
      {"a special cell has no two sides", [](P& p, F&) { p.behind[0] = kUncounted; }},
      {"a special cell has no two sides", [](P& p, F&) { p.beyond.back() = kUncounted; }},
      {"its planes do not add up",
       [](P& p, F&) {
         const auto at = std::ranges::find_if(p.plane_counts, [](auto n) { return n > 1; });
         ASSERT_NE(at, p.plane_counts.end());
         --*at;
       }},
      {"its planes do not add up",
       [](P& p, F&) {
         grow(p.head.plane_count, -1);
         p.planes.resize(p.planes.size() - 9);
       }},
  };
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity, 0x1p60, -0x1p60})
    all.push_back({"a plane is out of range", [value](P& p, F&) { p.planes.back() = value; }});
  return all;
}

}  // namespace

std::vector<MaskCorruption> all_mask_corruptions() {
  std::vector<MaskCorruption> all = head_corruptions();
  for (const auto& more : {node_corruptions(), leaf_corruptions(), mask_list_corruptions()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace planetree::octree
