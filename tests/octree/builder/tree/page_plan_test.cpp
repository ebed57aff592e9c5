#include "octree/builder/tree/page_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <string>
#include <utility>

#include "octree/builder/tree/page_encoder.h"
#include "octree/builder/tree/treelets.h"
#include "octree/geometry/octcode.h"
#include "octree/page/page_streams.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

struct Case {
  const char* name;
  Soup soup;
};

std::vector<Case> cases() {
  return {{"one triangle", repeated(1)},
          {"a triangle many times", repeated(2500)},
          {"sphere", sphere(5)},
          {"long triangles, float64", scattered(1500, 1.0)}};
}

// Walks a tree's records and where treelets are cut.
class CutWalk {
 public:
  CutWalk(const SampleTree& sample, const TreeletCut& cut) : sample_(sample), cut_(cut) {
    node_visits_.resize(sample.tree.nodes.size());
    block_visits_.resize(sample.tree.blocks.size());
  }

  // Number of slots of the treelet with root `record`.
  std::uint32_t slots(RecordRef record) {
    if (record.block) {
      ++block_visits_[record.index];
      return sample_.block_slots[record.index];
    }
    ++node_visits_[record.index];
    const WideNode& node = sample_.tree.nodes[record.index];
    std::uint32_t sum = kNodeSlots;
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      const bool apart = child.block ? cut_.cut_blocks[child.index] : cut_.cut_nodes[child.index];
      if (!apart) sum += slots({child.block, child.index});
    }
    return sum;
  }

  void expect_each_record_once() const {
    const auto once = [](const std::vector<unsigned>& visits) {
      return std::ranges::all_of(visits, [](unsigned count) { return count == 1; });
    };
    EXPECT_TRUE(once(node_visits_));
    EXPECT_TRUE(once(block_visits_));
  }

 private:
  const SampleTree& sample_;
  const TreeletCut& cut_;
  std::vector<unsigned> node_visits_, block_visits_;
};

TEST(Treelets, HoldEveryRecordOnceAndKeepTheirLimits) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SampleTree sample = build_sample(c.soup);
    for (const auto& [bottom, upper] : {std::pair(32u, 62u), std::pair(64u, 256u),
                                        std::pair(32u, 32u), std::pair(1024u, 4000u)}) {
      const TreeletCut cut =
          cut_treelets(sample.tree, {kNodeSlots, sample.block_slots}, bottom, upper);
      CutWalk walk(sample, cut);
      for (const Treelet& treelet : cut.treelets) {
        EXPECT_EQ(walk.slots(treelet.root), treelet.slots);
        EXPECT_LE(treelet.slots, std::max(bottom, upper));
      }
      walk.expect_each_record_once();
    }
  }
}

TEST(Treelets, FormOneTreeletWhereAllFits) {
  const SampleTree sample = build_sample(sphere(3));
  const TreeletCut cut =
      cut_treelets(sample.tree, {kNodeSlots, sample.block_slots}, 100000, 100000);
  ASSERT_EQ(cut.treelets.size(), 1u);
  EXPECT_EQ(cut.treelets[0].root.index, 0u);
}

TEST(Treelets, AreTheLargestSubtreesThatFitAtTheBottom) {
  const SampleTree sample = build_sample(sphere(5));
  const TreeletCut cut = cut_treelets(sample.tree, {kNodeSlots, sample.block_slots}, 100, 1000);
  // Such a treelet is a node and all below it, uncut, while the whole subtree of its parent is too
  // large.
  const TreeletCut none{{},
                        std::vector<bool>(sample.tree.nodes.size()),
                        std::vector<bool>(sample.tree.blocks.size())};
  std::size_t bottoms = 0;
  for (std::uint32_t at = 0; at < sample.tree.nodes.size(); ++at) {
    const std::uint32_t own = CutWalk(sample, none).slots({false, at});
    const WideNode& node = sample.tree.nodes[at];
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      if (child.block || CutWalk(sample, none).slots({false, child.index}) > 100) continue;
      EXPECT_EQ(cut.cut_nodes[child.index], own > 100);
      bottoms += own > 100;
    }
  }
  EXPECT_GT(bottoms, 20u);
}

using Key = std::pair<std::uint64_t, std::uint32_t>;

Key key_of(const PlannedPage& page) { return {page.octcode, page.ordinal}; }

// Checks the pages of a plan and the links between them.
class PlanCheck {
 public:
  PlanCheck(const SampleTree& sample)
      : sample_(sample), plan_(sample.plan), links_(sample.plan.page_bytes) {}

  void expect_each_record_at_its_slot() const {
    std::vector<unsigned> nodes(sample_.tree.nodes.size()), blocks(sample_.tree.blocks.size());
    for (std::uint32_t number = 0; number < plan_.pages.size(); ++number) {
      const PlannedPage& page = plan_.pages[number];
      std::uint32_t slot = frame_head_slots(plan_.page_bytes);
      for (const std::uint32_t node : page.nodes) {
        ++nodes[node];
        EXPECT_EQ(plan_.node_links[node], links_.make(false, number, slot));
        slot += kNodeSlots;
      }
      for (const std::uint32_t block : page.blocks) {
        ++blocks[block];
        EXPECT_EQ(plan_.block_links[block], links_.make(true, number, slot));
        slot += sample_.block_slots[block];
      }
      EXPECT_LE(slot * kSlotBytes, plan_.page_bytes);
    }
    EXPECT_TRUE(std::ranges::all_of(nodes, [](unsigned count) { return count == 1; }));
    EXPECT_TRUE(std::ranges::all_of(blocks, [](unsigned count) { return count == 1; }));
  }

  void expect_one_parent_page_each() const {
    std::vector<std::set<std::uint32_t>> parents(plan_.pages.size());
    std::set<std::uint32_t> roots = root_links();
    for (std::uint32_t at = 0; at < sample_.tree.nodes.size(); ++at) {
      const std::uint32_t own = links_.page(plan_.node_links[at]);
      const WideNode& node = sample_.tree.nodes[at];
      for (unsigned i = 0; i < node.child_count; ++i) {
        const WideChild& child = node.children[i];
        const std::uint32_t link =
            child.block ? plan_.block_links[child.index] : plan_.node_links[child.index];
        if (links_.page(link) == own) continue;
        EXPECT_GT(links_.page(link), own);
        parents[links_.page(link)].insert(own);
        EXPECT_EQ(roots.erase(link), 1u) << "a link to a record that is no root";
      }
    }
    EXPECT_TRUE(parents[0].empty());
    for (std::size_t page = 1; page < parents.size(); ++page) EXPECT_EQ(parents[page].size(), 1u);
    EXPECT_EQ(roots.size(), 1u);  // the root of the tree
  }

  void expect_ascending_keys() const {
    for (std::size_t page = 1; page < plan_.pages.size(); ++page)
      EXPECT_LT(key_of(plan_.pages[page - 1]), key_of(plan_.pages[page])) << page;
  }

 private:
  std::set<std::uint32_t> root_links() const {
    std::set<std::uint32_t> roots;
    for (const PlannedPage& page : plan_.pages) {
      for (std::size_t i = 0; i < page.root_node_count; ++i)
        roots.insert(plan_.node_links[page.nodes[i]]);
      for (std::size_t i = 0; i < page.root_block_count; ++i)
        roots.insert(plan_.block_links[page.blocks[i]]);
    }
    return roots;
  }

  const SampleTree& sample_;
  const PagePlan& plan_;
  LinkFormat links_;
};

TEST(PagePlan, IsConsistentForEveryMeshAndPageSize) {
  for (const Case& c : cases())
    for (std::uint32_t page_bytes = 4096; page_bytes <= 262144; page_bytes *= 2) {
      SCOPED_TRACE(std::string(c.name) + ", pages of " + std::to_string(page_bytes));
      const SampleTree sample = build_sample(c.soup, page_bytes);
      const PlanCheck check(sample);
      check.expect_each_record_at_its_slot();
      check.expect_one_parent_page_each();
      check.expect_ascending_keys();
    }
}

TEST(PagePlan, GivesTheRootPageZero) {
  const SampleTree sample = build_sample(sphere(5));
  EXPECT_EQ(LinkFormat(4096).page(sample.plan.node_links[0]), 0u);
  EXPECT_EQ(sample.plan.pages[0].nodes[0], 0u);
}

TEST(PagePlan, UsesOnePageForSmallTrees) {
  EXPECT_EQ(build_sample(sphere(3), 262144).plan.pages.size(), 1u);
  EXPECT_EQ(build_sample(repeated(1), 4096).plan.pages.size(), 1u);
}

TEST(PagePlan, FillsItsPages) {
  const SampleTree sample = build_sample(sphere(6), 16384);
  std::size_t used = 0;
  for (const PlannedPage& page : sample.plan.pages) {
    used += page.nodes.size() * kNodeSlots;
    for (const std::uint32_t block : page.blocks) used += sample.block_slots[block];
  }
  EXPECT_GT(used * kSlotBytes * 10, sample.plan.pages.size() * 16384 * 7);
}

TEST(PagePlan, NamesPagesByCellsThatHoldTheirFirstSubtree) {
  const SampleTree sample = build_sample(sphere(5));
  for (const PlannedPage& page : sample.plan.pages) {
    if (page.root_node_count == 0) continue;
    const Cell cell = cell_of_octcode(page.octcode);
    EXPECT_LE(cell.level, kLevels);
    EXPECT_LE(cell.within, 2u);
  }
}

TEST(PageEncoder, CountsBitEqualVerticesOnce) {
  const SampleTree same = build_sample(repeated(16));
  EXPECT_EQ(same.vertices.of_block(0).size(), 3u);
  const SampleTree apart = build_sample(scattered(16, 0.1));
  EXPECT_EQ(apart.vertices.of_block(0).size(), 48u);
}

TEST(PageEncoder, StoresEachVertexOfAPageOnce) {
  const SampleTree sample = build_sample(sphere(3), 262144);
  const SamplePages pages(sample);
  PageHead head;
  std::memcpy(&head, pages.raw(0).data(), sizeof head);
  EXPECT_EQ(head.triangle_count, 512);
  EXPECT_EQ(head.vertex_count, 258);  // Euler: 512 / 2 + 2
}

}  // namespace
}  // namespace planetree::octree
