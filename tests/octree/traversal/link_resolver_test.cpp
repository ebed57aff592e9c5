#include "octree/traversal/link_resolver.h"

#include <gtest/gtest.h>

#include <cstring>
#include <utility>
#include <vector>

#include "octree/nearest/nearest.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

/// A tree whose links lead to slots, and the same with links to numbers.
struct BothForms {
  BothForms(const Soup& soup, std::uint32_t page_bytes, bool moments = false)
      : slots(build_sample(soup, page_bytes, 0, moments)), numbers(slots) {
    numbers.shape.links = LinkTarget::kNumber;
  }
  SampleTree slots, numbers;
};

std::vector<BothForms> both_forms() {
  std::vector<BothForms> samples;
  samples.emplace_back(sphere(5), 4096);
  samples.emplace_back(sphere(5), 65536);
  samples.emplace_back(sphere(4), 4096, true);
  samples.emplace_back(scattered(3000, 0.1), 8192);
  samples.emplace_back(sphere(0), 4096);
  return samples;
}

void expect_same_node(const Node& a, const Node& b) {
  Node without_links = a;
  std::memcpy(without_links.link, b.link, sizeof b.link);
  EXPECT_EQ(std::memcmp(&without_links, &b, sizeof b), 0);
}

TEST(LinkResolver, FindsTheSameRecordsByNumbers) {
  for (const BothForms& sample : both_forms()) {
    SamplePages slot_pages(sample.slots), number_pages(sample.numbers);
    const PageReader of_slots = slot_pages.reader(), of_numbers = number_pages.reader();
    const TreeInfo slot_tree = tree_info(sample.slots), number_tree = tree_info(sample.numbers);
    LinkResolver by_slot(slot_tree, of_slots), by_number(number_tree, of_numbers);
    TraversalStats work;
    std::size_t records = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open{
        {slot_tree.root_link, number_tree.root_link}};
    while (!open.empty()) {
      const auto [slot, number] = open.back();
      open.pop_back();
      const std::byte *expected = by_slot.find(slot, work), *found = by_number.find(number, work);
      ASSERT_TRUE(expected && found);
      ASSERT_EQ(by_number.page(), by_slot.page());
      ASSERT_EQ(by_number.page_of(number), by_slot.page());
      ASSERT_EQ(LinkFormat::is_leaf(number), LinkFormat::is_leaf(slot));
      ++records;
      if (LinkFormat::is_leaf(slot)) {
        const BlockView block(found, number_tree.shape);
        ASSERT_EQ(std::memcmp(found, expected, block.slots() * kSlotBytes), 0);
        continue;
      }
      const auto &a = *reinterpret_cast<const Node*>(expected),
                 &b = *reinterpret_cast<const Node*>(found);
      expect_same_node(a, b);
      for (unsigned child = 0; child < a.child_count; ++child)
        open.emplace_back(a.link[child], b.link[child]);
    }
    EXPECT_EQ(records, slot_tree.record_count);
  }
}

TEST(LinkResolver, RefusesNumbersThatNoRecordHas) {
  for (const BothForms& sample : both_forms()) {
    SamplePages pages(sample.numbers);
    const PageReader reader = pages.reader();
    const TreeInfo tree = tree_info(sample.numbers);
    const LinkFormat links = LinkFormat::numbered(tree.page_bytes);
    LinkResolver records(tree, reader);
    TraversalStats work;
    for (std::uint32_t page = 0; page < pages.size(); ++page)
      for (std::uint32_t number = 0; number < max_page_blocks(tree.page_bytes); ++number) {
        const FrameHeader& head = pages.frame(page).header();
        EXPECT_EQ(records.find(links.make(false, page, number), work) != nullptr,
                  number < head.node_count);
        EXPECT_EQ(records.find(links.make(true, page, number), work) != nullptr,
                  number < head.block_count);
      }
    const auto behind = static_cast<std::uint32_t>(pages.size());
    EXPECT_EQ(records.find(links.make(false, behind, 0), work), nullptr);
    EXPECT_FALSE(records.has_page());
  }
}

// Links are in the order of the records in both forms, so that ties are broken the same way.
TEST(LinkResolver, LeadsSearchesTheSameWay) {
  for (const BothForms& sample : both_forms()) {
    SamplePages slot_pages(sample.slots), number_pages(sample.numbers);
    Noise noise(7);
    for (int i = 0; i < 200; ++i) {
      const Vec3 at = noise.point(-2, 2);
      const Point query(at.x, at.y, at.z);
      TraversalStats by_slot, by_number;
      const NearestAnswer expected =
          nearest(tree_info(sample.slots), query, {}, slot_pages.reader(), by_slot);
      const NearestAnswer found =
          nearest(tree_info(sample.numbers), query, {}, number_pages.reader(), by_number);
      EXPECT_EQ(found.distance, expected.distance);
      EXPECT_EQ(found.triangle, expected.triangle);
      EXPECT_EQ(found.status, expected.status);
      EXPECT_EQ(by_number.nodes, by_slot.nodes);
      EXPECT_EQ(by_number.blocks, by_slot.blocks);
      EXPECT_EQ(by_number.page_switches, by_slot.page_switches);
    }
  }
}

}  // namespace
}  // namespace planetree::octree
