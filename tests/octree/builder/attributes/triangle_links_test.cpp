#include "octree/builder/attributes/triangle_links.h"

#include <gtest/gtest.h>

#include <map>

#include "octree/attributes/attribute_page.h"
#include "octree/page/page_decoder.h"
#include "tests/octree/builder/chunked_tree.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

// The numbered links of the blocks of decoded pages.
std::map<std::uint64_t, std::uint32_t> links_of(const ChunkedTree& sample) {
  std::map<std::uint64_t, std::uint32_t> links;
  for (std::uint32_t number = 0; number < sample.tree->pages().size(); ++number) {
    const PageInfo info = sample.tree->info_of_page(number);
    SampleFrame frame(info.page_bytes);
    const auto raw = sample.tree->pages().encode(number);
    EXPECT_TRUE(raw && decode_page(raw->bytes, info, frame.bytes()));
    std::uint32_t slot = frame.header().first_block_slot;
    for (std::uint16_t block = 0; block < frame.header().block_count; ++block) {
      const BlockView view(frame.data() + slot * kSlotBytes, sample.shape);
      for (unsigned i = 0; i < view.triangle_count(); ++i)
        links[view.id(i)] = LinkFormat::numbered(info.page_bytes).make_block({number, block});
      slot += view.slots();
    }
  }
  return links;
}

TEST(TriangleLinks, LeadToTheBlocksOfTheTree) {
  constexpr std::uint32_t kSmallPages = 4096;
  for (const std::uint32_t in_page : {84U, 3U}) {  // the least: more buckets than one
    const ChunkedTree sample(sphere(4), 300, kSmallPages);
    const auto expected = links_of(sample);
    const std::uint64_t indices = expected.rbegin()->first + 5;  // the last have no triangle
    TriangleLinks links(indices, in_page, sample.shape, kSmallPages, spill_file());
    for (std::uint32_t number = sample.tree->pages().size(); number-- > 0;)
      ASSERT_TRUE(links.add(number, sample.tree->pages().encode(number)->bytes));
    const std::uint64_t in_bucket = std::uint64_t{links.pages_per_bucket()} * in_page;
    for (std::uint64_t first = 0; first < indices; first += in_bucket) {
      const auto found = links.links(static_cast<std::uint32_t>(first / in_bucket));
      ASSERT_TRUE(found);
      ASSERT_EQ(found->size(), std::min(in_bucket, indices - first));
      for (std::uint64_t i = 0; i < found->size(); ++i) {
        const auto at = expected.find(first + i);
        EXPECT_EQ((*found)[i], at == expected.end() ? kNoLink : at->second);
      }
    }
    EXPECT_EQ(in_page == 3, indices > in_bucket);
  }
}

}  // namespace
}  // namespace planetree::octree
