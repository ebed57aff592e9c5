#include "octree/page/frame.h"

#include <gtest/gtest.h>

#include "octree/page/page_streams.h"

namespace planetree::octree {
namespace {

constexpr std::uint32_t kPageSizes[] = {4096, 8192, 16384, 32768, 65536, 131072, 262144};

TEST(LinkFormat, RoundTripsKindPageAndSlot) {
  for (const std::uint32_t page_bytes : kPageSizes) {
    const LinkFormat links(page_bytes, LinkTarget::kSlot);
    const auto last_slot = static_cast<std::uint32_t>(page_bytes / kSlotBytes - 1);
    for (const std::uint32_t page : {0u, 1u, links.max_pages() / 3, links.max_pages() - 1})
      for (const std::uint32_t slot : {0u, 2u, last_slot})
        for (const bool leaf : {false, true}) {
          const std::uint32_t link = links.make(leaf, page, slot);
          EXPECT_EQ(LinkFormat::is_leaf(link), leaf);
          EXPECT_EQ(links.page(link), page);
          EXPECT_EQ(links.record(link), slot);
        }
  }
}

TEST(LinkFormat, LimitsPageCountByPageSize) {
  const auto of_slots = [](std::uint32_t page_bytes) {
    return LinkFormat(page_bytes, LinkTarget::kSlot).max_pages();
  };
  EXPECT_EQ(of_slots(4096), 1u << 25);
  EXPECT_EQ(of_slots(65536), 1u << 21);
  EXPECT_EQ(of_slots(262144), 1u << 19);
  for (const std::uint32_t page_bytes : kPageSizes)
    EXPECT_EQ(LinkFormat::numbered(page_bytes).max_pages(), 4 * of_slots(page_bytes) - 1);
}

TEST(LinkFormat, HasNumbersWhereSlotsDoNotSuffice) {
  for (const std::uint32_t page_bytes : kPageSizes) {
    const std::uint32_t most = LinkFormat(page_bytes, LinkTarget::kSlot).max_pages();
    EXPECT_EQ(LinkFormat::of_pages(page_bytes, 0).target(), LinkTarget::kSlot);
    EXPECT_EQ(LinkFormat::of_pages(page_bytes, most).target(), LinkTarget::kSlot);
    EXPECT_EQ(LinkFormat::of_pages(page_bytes, most + 1).target(), LinkTarget::kNumber);
  }
}

TEST(LinkFormat, RoundTripsNumberedLinks) {
  for (const std::uint32_t page_bytes : kPageSizes) {
    const LinkFormat links = LinkFormat::numbered(page_bytes);
    const auto last = static_cast<std::uint16_t>(max_page_blocks(page_bytes) - 1);
    for (const std::uint16_t number : {std::uint16_t{0}, std::uint16_t{1}, last}) {
      const std::uint32_t link = links.make_block({links.max_pages() - 1, number});
      EXPECT_TRUE(LinkFormat::is_leaf(link));
      EXPECT_EQ(links.page(link), links.max_pages() - 1);
      EXPECT_EQ(links.record(link), number);
      EXPECT_NE(link, ~std::uint32_t{0});
    }
  }
}

TEST(RootLink, LeadsToTheFirstRecordOfTheFirstPage) {
  for (const std::uint32_t page_bytes : kPageSizes)
    for (const LinkTarget target : {LinkTarget::kSlot, LinkTarget::kNumber}) {
      const LinkFormat links(page_bytes, target);
      const std::uint32_t node = root_link_of(page_bytes, target, 7, 1),
                          block = root_link_of(page_bytes, target, 7, 0);
      EXPECT_EQ(node, node_link(page_bytes, {.links = target}, {7, 0}));
      EXPECT_EQ(block, links.make(true, 7, links.record(node)));
    }
}

TEST(FrameHead, HasASlotNumberForEveryBlock) {
  for (const std::uint32_t page_bytes : kPageSizes) {
    const std::size_t slots = page_bytes / kSlotBytes - frame_head_slots(page_bytes);
    EXPECT_LE(slots / BlockShape{}.slots(1, true), max_page_blocks(page_bytes));
    EXPECT_LE(max_page_blocks(page_bytes) * sizeof(std::uint16_t),
              (frame_head_slots(page_bytes) - 1) * kSlotBytes);
  }
  EXPECT_EQ(frame_head_slots(4096), 2u);
  EXPECT_EQ(frame_head_slots(65536), 9u);
  EXPECT_EQ(frame_head_slots(262144), 33u);
}

TEST(FrameHead, LeavesSlotsForTheNodesOfAPage) {
  for (const std::uint32_t page_bytes : kPageSizes)
    for (const BlockShape& shape : {BlockShape{}, BlockShape{.moments = true}}) {
      const auto last = static_cast<std::uint16_t>(max_page_nodes(page_bytes, shape) - 1);
      const LinkFormat links(page_bytes, LinkTarget::kSlot);
      const std::uint32_t link = node_link(page_bytes, shape, {5, last});
      EXPECT_EQ(links.page(link), 5u);
      EXPECT_LE(links.record(link) + shape.node_slots(), page_bytes / kSlotBytes);
      EXPECT_GT(links.record(link) + 2 * shape.node_slots(), page_bytes / kSlotBytes);
      BlockShape numbered_shape = shape;
      numbered_shape.links = LinkTarget::kNumber;
      const LinkFormat numbers = LinkFormat::numbered(page_bytes);
      const std::uint32_t numbered = node_link(page_bytes, numbered_shape, {5, last});
      EXPECT_EQ(numbers.page(numbered), 5u);
      EXPECT_EQ(numbers.record(numbered), last);
    }
}

TEST(BlockShape, SlotCountsMatchTheSpecification) {
  struct Row {
    unsigned vertices, narrow, wide;
  };
  constexpr Row kRows[] = {{1, 5, 11},  {16, 5, 11}, {17, 7, 16},  {24, 7, 16},
                           {25, 8, 20}, {32, 8, 20}, {33, 11, 29}, {48, 11, 29}};
  for (const Row& row : kRows) {
    EXPECT_EQ((BlockShape{false, false}.slots(row.vertices, false)), row.narrow);
    EXPECT_EQ((BlockShape{true, false}.slots(row.vertices, false)), row.wide);
    EXPECT_EQ((BlockShape{false, true}.slots(row.vertices, false)), row.narrow + 1);
    EXPECT_EQ((BlockShape{true, true}.slots(row.vertices, false)), row.wide + 1);
  }
  EXPECT_EQ(BlockShape{}.slots(16, true), 4u);
  EXPECT_TRUE(BlockShape{}.may_be_compact(16));
  EXPECT_FALSE(BlockShape{}.may_be_compact(17));
  EXPECT_FALSE((BlockShape{true, false}.may_be_compact(16)));
  EXPECT_FALSE((BlockShape{false, true}.may_be_compact(16)));
}

TEST(BlockShape, ArraysDoNotOverlap) {
  for (const unsigned stride : {16u, 24u, 32u, 48u})
    for (const bool float64 : {false, true}) {
      const BlockShape shape{float64, false};
      EXPECT_GE(shape.exact_offset(stride), kSlotBytes + 3 * stride * sizeof(float));
      EXPECT_GE(shape.id_offset(stride),
                shape.exact_offset(stride) + (float64 ? 3 * stride * sizeof(double) : 0));
      EXPECT_EQ(shape.id_offset(stride) % kSlotBytes, 0u);
    }
}

TEST(Corners, FillWholeBytesPerBlock) {
  EXPECT_EQ(corner_bits(16), 4u);
  EXPECT_EQ(corner_bits(17), 5u);
  EXPECT_EQ(corner_bits(33), 6u);
  EXPECT_EQ(corner_bytes(1, 3), 2u);
  EXPECT_EQ(corner_bytes(16, 48), 36u);
  EXPECT_EQ(corner_bytes(3, 20), 6u);
}

}  // namespace
}  // namespace planetree::octree
