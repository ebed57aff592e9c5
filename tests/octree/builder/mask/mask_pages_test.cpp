#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <string>

#include "octree/builder/mask/mask_encoder.h"
#include "octree/page/page_decoder.h"
#include "tests/octree/mask/random_mask.h"
#include "tests/octree/support/sample_mask.h"

// Masks through the stages of their pages: planned, encoded, decoded.
namespace planetree::octree {
namespace {

using Kind = MaskEntry::Kind;

std::vector<std::uint32_t> page_sizes() {
  return {4096, 8192, 16384, 32768, 65536, 131072, 262144};
}

/// Walks the entries of a mask and the records in its frames in parallel, and compares them.
class FrameWalk {
 public:
  FrameWalk(const MaskTree& tree, const MaskPages& pages)
      : tree_(tree), pages_(pages), links_(pages.plan().page_bytes) {}

  void run() {
    std::vector<Step> queue = {{0, {}, 0, mask_head_slots(pages_.plan().page_bytes)}};
    for (std::size_t i = 0; i < queue.size() && !testing::Test::HasFailure(); ++i) {
      const Step step = queue[i];
      EXPECT_TRUE(visited_.insert({step.page, step.slot}).second);
      const MaskEntry& entry = tree_.entries[step.entry];
      EXPECT_EQ(is_node(frame(step), step.slot), entry.kind == Kind::kNode);
      if (entry.kind == Kind::kCorners) look_at_corners(step, entry);
      if (entry.kind == Kind::kSpecial) look_at_special(step, tree_.specials[entry.first]);
      if (entry.kind == Kind::kListed) look_at_listed(step, entry);
      if (entry.kind == Kind::kNode) look_at_node(step, entry, queue);
    }
    EXPECT_EQ(visited_.size(), tree_.entries.size());
    for (std::uint32_t page = 0; page < pages_.size(); ++page)
      EXPECT_EQ(header_of(pages_.frame(page)).page_link_count, links_out_of_[page]) << page;
  }

  /// Parents of each page but the first.
  const std::map<std::uint32_t, std::set<std::uint32_t>>& parents() const { return parents_; }
  const std::map<std::uint32_t, std::uint64_t>& keys() const { return keys_; }

 private:
  struct Step {
    std::uint32_t entry;
    GridCell cell;
    std::uint32_t page, slot;
  };
  const SampleFrame& frame(const Step& step) const { return pages_.frame(step.page); }

  void look_at_corners(const Step& step, const MaskEntry& entry) {
    const auto& corners = *reinterpret_cast<const MaskCorners*>(slot_of(frame(step), step.slot));
    EXPECT_EQ(corners, entry.corners);
    EXPECT_FALSE(is_special(corners));
    EXPECT_FALSE(is_listed(corners));
  }

  void look_at_listed(const Step& step, const MaskEntry& entry) {
    const std::byte* record = slot_of(frame(step), step.slot);
    const auto& corners = *reinterpret_cast<const MaskCorners*>(record);
    EXPECT_TRUE(is_listed(corners));
    EXPECT_FALSE(is_special(corners));
    const auto& found = *reinterpret_cast<const MaskListed*>(record);
    for (unsigned i = 0; i < 8; ++i)
      EXPECT_EQ(found.least + (found.higher >> i & 1), entry.corners[i]);
    MaskBlocks blocks;
    blocks.count = found.block_count;
    const std::byte* list = slot_of(frame(step), found.list_slot);
    std::memcpy(blocks.octants.data(), list, blocks.count);
    list += list_octant_slots(blocks.count) * kMaskSlotBytes;
    std::uint32_t slab;
    std::memcpy(&slab, list, sizeof slab);
    blocks.slab = CellSlab::of_word(slab);
    list += sizeof slab;
    std::memcpy(blocks.links.data(), list, blocks.count * sizeof blocks.links[0]);
    EXPECT_TRUE(same(blocks, tree_.lists[entry.first]));
  }

  void look_at_special(const Step& step, const SpecialCell& special) {
    const std::byte* record = slot_of(frame(step), step.slot);
    EXPECT_TRUE(is_special(*reinterpret_cast<const MaskCorners*>(record)));
    const auto& found = *reinterpret_cast<const MaskSpecial*>(record);
    ASSERT_EQ(found.plane_count, special.plane_count);
    EXPECT_EQ(found.behind, special.behind);
    EXPECT_EQ(found.beyond, special.beyond);
    const auto* at = reinterpret_cast<const double*>(slot_of(frame(step), found.plane_slot));
    for (unsigned i = 0; i < special.plane_count; ++i)
      for (const Point& corner : special.planes[i])
        for (const double value : corner) EXPECT_EQ(*at++, value);
  }

  void look_at_node(const Step& step, const MaskEntry& entry, std::vector<Step>& queue) {
    const auto& node = *reinterpret_cast<const MaskNode*>(slot_of(frame(step), step.slot));
    EXPECT_EQ(node.grey, entry.grey);
    EXPECT_EQ(node.leaf(), entry.leaf);
    EXPECT_EQ(node.black(), entry.black);
    EXPECT_EQ(node.inverted, entry.inverted);
    if (entry.grey == 0) {
      EXPECT_EQ(node.family(), 0u);
      return;
    }
    const std::uint32_t page = links_.page(node.family());
    std::uint32_t slot = links_.slot(node.family());
    const StoredLink planned = pages_.plan().families[step.entry];
    EXPECT_EQ(page, planned.page);
    EXPECT_EQ(slot, mask_head_slots(pages_.plan().page_bytes) + planned.record);
    const MaskHeader& head = header_of(pages_.frame(page));
    const bool first = slot - head.first_record_slot < head.root_count;
    EXPECT_EQ(first, page != step.page);
    if (page != step.page) {
      EXPECT_GT(page, step.page);
      ++links_out_of_[step.page];
      parents_[page].insert(step.page);
      const auto key = keys_.try_emplace(page, step.cell.octcode()).first;
      key->second = std::min(key->second, step.cell.octcode());
    }
    std::uint32_t child = entry.first;
    for (unsigned octant = 0; octant < 8; ++octant)
      if ((entry.grey >> octant & 1) != 0)
        queue.push_back({child++, step.cell.child(octant), page, slot++});
    EXPECT_LE(slot, std::uint32_t{head.first_record_slot} + head.record_count);
  }

  const MaskTree& tree_;
  const MaskPages& pages_;
  const MaskLinkFormat links_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> visited_;
  std::map<std::uint32_t, std::set<std::uint32_t>> parents_;
  std::map<std::uint32_t, std::uint64_t> keys_ = {{0, 0}};
  std::map<std::uint32_t, unsigned> links_out_of_;
};

unsigned levels_of_pages(const std::map<std::uint32_t, std::set<std::uint32_t>>& parents) {
  unsigned most = 0;
  for (const auto& [page, above] : parents) {
    unsigned levels = 1;
    for (std::uint32_t at = page; at != 0; at = *parents.at(at).begin()) ++levels;
    most = std::max(most, levels);
  }
  return most;
}

TEST(MaskPagesTest, HoldEveryEntryAtEveryPageSize) {
  const MaskTree tree = random_mask(10);
  ASSERT_GT(tree.entries.size(), 20000u);
  ASSERT_GT(tree.lists.size(), 500u);
  bool float64 = false;
  for (const std::uint32_t page_bytes : page_sizes()) {
    SCOPED_TRACE(std::to_string(page_bytes));
    float64 = !float64;
    MaskTree rounded = tree;
    if (!float64)
      for (SpecialCell& special : rounded.specials)
        for (Triangle& plane : special.planes)
          for (Point& corner : plane) corner = corner.cast<float>().cast<double>();
    const MaskPages pages(rounded, page_bytes, kRandomMaskPage, float64);
    FrameWalk walk(rounded, pages);
    walk.run();
    ASSERT_EQ(walk.parents().size(), pages.size() - 1);
    for (const auto& [page, above] : walk.parents()) EXPECT_EQ(above.size(), 1u) << page;
    for (const auto& [page, octcode] : walk.keys()) {
      EXPECT_EQ(pages.plan().pages[page].octcode, octcode);
      EXPECT_EQ(header_of(pages.frame(page)).octcode, octcode);
      EXPECT_EQ(header_of(pages.frame(page)).page_number, kRandomMaskPage + page);
      if (page > 0) {
        EXPECT_LT(pages.plan().pages[page - 1].octcode, octcode);
      }
    }
    EXPECT_EQ(header_of(pages.frame(0)).root_count, 1);
    if (page_bytes == 4096) {
      EXPECT_GT(levels_of_pages(walk.parents()), 2u);
    }
  }
}

TEST(MaskPagesTest, FillMostOfEachPage) {
  const MaskTree tree = random_mask(10);
  for (const std::uint32_t page_bytes : {4096u, 65536u}) {
    const MaskPages pages(tree, page_bytes, kRandomMaskPage);
    std::size_t used = 0;
    for (std::uint32_t page = 0; page < pages.size(); ++page)
      for (const std::uint32_t at : pages.plan().pages[page].entries) {
        const MaskEntry& entry = tree.entries[at];
        used += 1;
        if (entry.kind == Kind::kSpecial)
          used += kPlaneSlots * tree.specials[entry.first].plane_count;
        if (entry.kind == Kind::kListed) used += list_slots(tree.lists[entry.first].count);
      }
    EXPECT_GT(10 * used * kMaskSlotBytes, 6u * pages.size() * page_bytes);
  }
}

TEST(MaskPagesTest, UseOnePageWhereAllFits) {
  for (const Soup& soup : {box({0, 0, 0}, {1, 1, 1}), sphere(3)}) {
    const SampleMask sample(soup);
    const MaskPages pages(sample.tree, 65536);
    EXPECT_EQ(pages.size(), 1u);
    FrameWalk(sample.tree, pages).run();
  }
}

}  // namespace
}  // namespace planetree::octree
