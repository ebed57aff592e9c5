#include "tools/check/file_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "tests/tools/check/mask_check_fixture.h"

// Issues that verify finds in masks. Each forged page has right hashes.
namespace planetree::tools {
namespace {

TEST_F(FileCheckOfMasks, AcceptsIntactMasks) {
  for (const auto& tree : {boxes(), sphere()})
    for (const bool full : {true, false}) {
      const CheckReport report = check_path(tree, full);
      const storage::FileHeader header = storage::FileImage(storage::read_bytes(tree)).header();
      EXPECT_EQ(codes_of(report), Codes{});
      EXPECT_EQ(report.pages, header.page_count);
      EXPECT_EQ(report.mask_cells, header.model.mask_cell_count);
      EXPECT_GT(report.mask_cells, 50u);
    }
  EXPECT_GT(storage::FileImage(storage::read_bytes(sphere())).header().model.mask_page_count, 2u);
}

bool has_corners(const RawMaskPage& page) { return page.head.corners_count > 0; }
bool has_special(const RawMaskPage& page) { return page.head.special_count > 0; }

TEST_F(FileCheckOfMasks, FindsWrongCornerNumbers) {
  for (const std::size_t corner : {0u, 3u, 7u})
    expect_found("MASK_CORNER", has_corners, [&](RawMaskPage& page) {
      page.corners[corner] = static_cast<std::int8_t>(page.corners[corner] + 1);
    });
  expect_found("MASK_CORNER", has_corners, [](RawMaskPage& page) {
    page.corners.back() = static_cast<std::int8_t>(page.corners.back() - 1);
  });
  for (const unsigned corner : {0u, 5u})
    expect_found("MASK_CORNER", has_lists, [&](RawMaskPage& page) {
      page.higher.back() ^= static_cast<std::uint8_t>(1u << corner);
    });
}

// A corner number that is not stored is not wrong.
TEST_F(FileCheckOfMasks, AllowsUncountedCorners) {
  const auto unsay = [](RawMaskPage& page) {
    std::fill_n(page.corners.begin(), 8, octree::kUncounted);
  };
  EXPECT_EQ(codes_of_change(boxes(), has_corners, unsay), Codes{});
}

using Node = std::optional<std::size_t>;

std::function<bool(const RawMaskPage&)> has(const std::function<Node(const RawMaskPage&)>& find) {
  return [find](const RawMaskPage& page) { return find(page).has_value(); };
}

// Index of the first node for which octants(index) is not 0.
Node node_with(const RawMaskPage& page, const std::function<unsigned(std::size_t)>& octants) {
  for (std::size_t i = 0; i < page.grey.size(); ++i)
    if (octants(i) != 0) return i;
  return {};
}

std::uint8_t lowest(unsigned bits) { return static_cast<std::uint8_t>(bits & -bits); }

TEST_F(FileCheckOfMasks, FindsWrongColours) {
  const auto black = [](const RawMaskPage& page) {
    return node_with(page, [&](std::size_t i) { return page.black[i]; });
  };
  const auto inverted = [](const RawMaskPage& page) {
    return node_with(page, [&](std::size_t i) { return page.inverted[i]; });
  };
  const auto white_of = [](const RawMaskPage& page, std::size_t i) {
    return 0xffu & ~(unsigned{page.grey[i]} | page.black[i] | page.inverted[i]);
  };
  const auto white = [&](const RawMaskPage& page) {
    return node_with(page, [&](std::size_t i) { return white_of(page, i); });
  };
  expect_found("MASK_COLOUR", has(black), [&](RawMaskPage& page) {
    page.black[*black(page)] ^= lowest(page.black[*black(page)]);
  });
  expect_found("MASK_COLOUR", has(black), [&](RawMaskPage& page) {
    const std::size_t at = *black(page);
    page.inverted[at] |= lowest(page.black[at]);
    page.black[at] ^= lowest(page.black[at]);
  });
  expect_found("MASK_COLOUR", has(inverted), [&](RawMaskPage& page) {
    const std::size_t at = *inverted(page);
    page.black[at] |= lowest(page.inverted[at]);
    page.inverted[at] ^= lowest(page.inverted[at]);
  });
  expect_found("MASK_COLOUR", has(white), [&](RawMaskPage& page) {
    const std::size_t at = *white(page);
    page.black[at] |= lowest(white_of(page, at));
  });
}

// A leaf is moved to the octant beside it, so that the surface lies in a white cell.
TEST_F(FileCheckOfMasks, FindsTrianglesInCellsOfOneColour) {
  const auto movable = [](const RawMaskPage& page, std::size_t i) {
    const unsigned other = unsigned{page.grey[i]} | page.black[i] | page.inverted[i];
    return unsigned{page.leaf[i]} & ~(other >> 1) & 0x7f;
  };
  const auto fits = [&](const RawMaskPage& page) {
    return node_with(page, [&](std::size_t i) { return movable(page, i); });
  };
  bool reported = false;
  Forgery forgery;
  forgery.mask = [&, done = false](std::uint32_t, RawMaskPage& page) mutable {
    if (done || !fits(page)) return;
    done = true;
    const std::size_t at = *fits(page);
    const unsigned bit = lowest(movable(page, at));
    page.grey[at] = static_cast<std::uint8_t>(page.grey[at] ^ (bit | bit << 1));
    page.leaf[at] = static_cast<std::uint8_t>(page.leaf[at] ^ (bit | bit << 1));
  };
  const CheckReport report = check_forgery(boxes(), forgery, true);
  for (const Issue& issue : report.issues.kept())
    reported = reported || (issue.code == IssueCode::kMaskColour &&
                            issue.message.find("triangles touch it") != std::string::npos);
  EXPECT_TRUE(reported);
}

TEST_F(FileCheckOfMasks, FindsWrongPlanes) {
  expect_found("MASK_PLANES", has_special,
               [](RawMaskPage& page) { std::swap(page.behind[0], page.beyond[0]); });
  expect_found("MASK_PLANES", has_special, [](RawMaskPage& page) { page.behind[0] = 5; });
  expect_found("MASK_PLANES", has_special, [](RawMaskPage& page) { page.beyond.back() = -5; });
  // Swaps corners b and c, so that the plane faces the other way.
  expect_found("MASK_PLANES", has_special, [](RawMaskPage& page) {
    std::swap_ranges(page.planes.begin() + 3, page.planes.begin() + 6, page.planes.begin() + 6);
  });
  // Shifts a plane along its normal by one unit in the last place of a float.
  expect_found("MASK_PLANES", has_special, [](RawMaskPage& page) {
    const double* at = page.planes.data();
    const octree::Point a(at[0], at[1], at[2]), b(at[3], at[4], at[5]), c(at[6], at[7], at[8]);
    for (unsigned axis = 0; axis < 3; ++axis) {
      if (a[axis] != b[axis] || a[axis] != c[axis]) continue;
      const float shifted = std::nextafter(static_cast<float>(a[axis]), 9.0f);
      for (std::size_t corner = 0; corner < 3; ++corner)
        page.planes[3 * corner + axis] = static_cast<double>(shifted);
    }
  });
}

TEST_F(FileCheckOfMasks, FindsWrongCountsInTheHeader) {
  const auto codes_with = [&](const std::function<void(storage::ModelRecord&)>& change) {
    Forgery forgery;
    forgery.model = change;
    return codes_of(check_forgery(boxes(), forgery, false));
  };
  EXPECT_EQ(codes_with([](auto& model) { ++model.mask_cell_count; }), Codes{"COUNT"});
  EXPECT_EQ(codes_with([](auto& model) { --model.mask_cell_count; }), Codes{"COUNT"});
  EXPECT_EQ(codes_with([](auto& model) { ++model.mask_levels; }), Codes{"COUNT"});
  EXPECT_EQ(codes_with([](auto& model) { --model.mask_levels; }), Codes{"COUNT"});
}

bool has_links(const RawMaskPage& page) { return page.linked_pages.size() > 1; }

TEST_F(FileCheckOfMasks, FindsLinksThatLeadNowhere) {
  for (const int by : {1, -1, 400})
    for (const bool full : {true, false}) {
      const Codes codes = codes_of_change(
          sphere(), has_links,
          [&](RawMaskPage& page) {
            page.linked_records[1] = static_cast<std::uint16_t>(page.linked_records[1] + by);
          },
          full);
      // The record before or after a family of one member may be the start of another family.
      EXPECT_TRUE(codes.contains("LINK_TARGET") || codes.contains("LINK_TWICE")) << by;
      EXPECT_TRUE(codes.contains("SUBTREE_UNLINKED")) << by;
    }
}

TEST_F(FileCheckOfMasks, FindsTwoLinksToOneFamily) {
  const Codes codes = codes_of_change(sphere(), has_links, [](RawMaskPage& page) {
    page.linked_pages[1] = page.linked_pages[0];
    page.linked_records[1] = page.linked_records[0];
  });
  EXPECT_TRUE(codes.contains("LINK_TWICE"));
  EXPECT_TRUE(codes.contains("SUBTREE_UNLINKED"));
}

// Index, among the nodes of a page, of one whose family lies in another page and has several
// members.
Node node_above(const RawMaskPage& page) {
  std::size_t node = 0;
  for (const std::uint8_t kind : page.kinds) {
    const bool above = kind == static_cast<std::uint8_t>(MaskKind::kNodeWithLink);
    if (above && std::popcount(page.grey[node]) > 1) return node;
    node += above || kind == static_cast<std::uint8_t>(MaskKind::kNode) ? 1 : 0;
  }
  return {};
}

TEST_F(FileCheckOfMasks, FindsFamiliesOfOtherKindsThanTheirNodeSays) {
  const Codes kinds = codes_of_change(sphere(), has(node_above), [](RawMaskPage& page) {
    const std::size_t at = *node_above(page);
    page.leaf[at] ^= lowest(page.grey[at]);
  });
  EXPECT_TRUE(kinds.contains("LINK_TARGET"));
  // One member fewer: the last one has no parent.
  const Codes fewer = codes_of_change(sphere(), has(node_above), [](RawMaskPage& page) {
    const std::size_t at = *node_above(page);
    const auto kept = static_cast<std::uint8_t>(~unsigned{lowest(page.grey[at])});
    page.grey[at] &= kept;
    page.leaf[at] &= kept;
  });
  EXPECT_TRUE(fewer.contains("SUBTREE_UNLINKED"));
}

TEST_F(FileCheckOfMasks, FindsASecondRoot) {
  bool first = true;
  const auto is_first = [&](const RawMaskPage&) { return std::exchange(first, false); };
  const auto add_root = [](RawMaskPage& page) {
    page.kinds.insert(page.kinds.begin() + 1, static_cast<std::uint8_t>(MaskKind::kPlainCorners));
    page.plain_corners.insert(page.plain_corners.begin(), 0);
    ++page.head.record_count;
    ++page.head.plain_count;
    ++page.head.root_count;
  };
  EXPECT_EQ(codes_of_change(tetrahedron(), is_first, add_root, false), Codes{"PAGE_STRUCTURE"});
}

// Twenty nodes, each the child of the one before.
TEST_F(FileCheckOfMasks, FindsCellsBelowTheFinestLevel) {
  Forgery forgery;
  forgery.mask = [](std::uint32_t, RawMaskPage& page) {
    constexpr std::uint8_t kNodes = octree::kLevels + 1;
    RawMaskPage chain;
    chain.head.page_number = page.head.page_number;
    chain.head.octcode = page.head.octcode;
    chain.head.record_count = kNodes + 1;
    chain.head.root_count = chain.head.plain_count = 1;
    chain.head.node_count = kNodes;
    chain.kinds.assign(kNodes, static_cast<std::uint8_t>(MaskKind::kNode));
    chain.kinds.push_back(static_cast<std::uint8_t>(MaskKind::kPlainCorners));
    chain.grey.assign(kNodes, 0x80);
    chain.leaf.assign(kNodes, 0);
    chain.leaf.back() = 0x80;
    chain.black = chain.inverted = std::vector<std::uint8_t>(kNodes, 0);
    chain.plain_corners = {0};
    page = chain;
  };
  forgery.model = [](storage::ModelRecord& model) {
    model.mask_cell_count = octree::kLevels + 1;
    model.mask_levels = octree::kLevels;
  };
  const std::filesystem::path one_page =
      PLANETREE_SOURCE_DIR "/format-spec/v1/samples/tetrahedron.ptree";
  EXPECT_EQ(codes_of(check_forgery(one_page, forgery, false)), Codes{"PAGE_STRUCTURE"});
}

// A lost page is reported once, without the pages that only it links to.
TEST_F(FileCheckOfMasks, ReportsOnlyALostPage) {
  const Bytes bytes = storage::read_bytes(sphere());
  const storage::FileHeader header = storage::FileImage(bytes).header();
  for (std::uint32_t page = header.first_mask_page(); page < header.page_count; ++page) {
    storage::FileImage image(bytes);
    image.stored(page)[20] ^= std::byte{1};
    storage::write_bytes(folder_ / "lost.ptree", image.bytes());
    const CheckReport report = check_path(folder_ / "lost.ptree", false);
    EXPECT_EQ(codes_of(report), Codes{"PAGE_CHECKSUM"}) << page;
    EXPECT_EQ(report.pages, header.page_count - 1);
  }
}

TEST_F(FileCheckOfMasks, FindsMaskPagesWithBadStructure) {
  const auto any = [](const RawMaskPage&) { return true; };
  EXPECT_TRUE(codes_of_change(boxes(), any, [](RawMaskPage& page) {
                page.kinds[0] = 9;
              }).contains("PAGE_STRUCTURE"));
}

}  // namespace
}  // namespace planetree::tools
