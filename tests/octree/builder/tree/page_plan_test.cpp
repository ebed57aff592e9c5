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

// Walks a tree's nodes and where treelets are cut.
class CutWalk {
 public:
  CutWalk(const WideTree& tree, const RecordSlots& slots, const TreeletCut& cut)
      : tree_(tree), slots_(slots), cut_(cut), visits_(tree.nodes.size()) {}

  // Number of slots of the treelet with root `at`.
  std::uint32_t slots(std::uint32_t at) {
    ++visits_[at];
    const WideNode& node = tree_.nodes[at];
    std::uint32_t sum = kNodeSlots;
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      if (child.block)
        sum += slots_.blocks[child.index];
      else if (!cut_.cut_nodes[child.index])
        sum += slots(child.index);
    }
    return sum;
  }

  void expect_each_node_once() const {
    EXPECT_TRUE(std::ranges::all_of(visits_, [](unsigned count) { return count == 1; }));
  }

 private:
  const WideTree& tree_;
  const RecordSlots slots_;
  const TreeletCut& cut_;
  std::vector<unsigned> visits_;
};

TEST(Treelets, HoldEveryNodeOnceAndKeepTheirLimits) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SampleTree sample = build_sample(c.soup);
    if (sample.tree.nodes.empty()) continue;
    const RecordSlots slots{kNodeSlots, sample.block_slots};
    const std::uint32_t least = bottom_slots(4096, slots);
    for (const auto& [bottom, upper] : {std::pair(least, 62u), std::pair(64u, 256u),
                                        std::pair(least, least), std::pair(1024u, 4000u)}) {
      const TreeletCut cut = cut_treelets(sample.tree, slots, bottom, upper);
      CutWalk walk(sample.tree, slots, cut);
      for (const Treelet& treelet : cut.treelets) {
        EXPECT_EQ(walk.slots(treelet.root), treelet.slots);
        EXPECT_LE(treelet.slots, std::max(bottom, upper));
      }
      walk.expect_each_node_once();
    }
  }
}

TEST(Treelets, FormOneTreeletWhereAllFits) {
  const SampleTree sample = build_sample(sphere(3));
  const TreeletCut cut =
      cut_treelets(sample.tree, {kNodeSlots, sample.block_slots}, 100000, 100000);
  ASSERT_EQ(cut.treelets.size(), 1u);
  EXPECT_EQ(cut.treelets[0].root, 0u);
}

TEST(Treelets, AreTheLargestSubtreesThatFitAtTheBottom) {
  const SampleTree sample = build_sample(sphere(5));
  const RecordSlots slots{kNodeSlots, sample.block_slots};
  const TreeletCut cut = cut_treelets(sample.tree, slots, 100, 1000);
  // Such a treelet is a node and all below it, uncut, while the whole subtree of its parent is too
  // large.
  const TreeletCut none{{}, std::vector<bool>(sample.tree.nodes.size())};
  const auto whole = [&](std::uint32_t at) { return CutWalk(sample.tree, slots, none).slots(at); };
  std::size_t bottoms = 0;
  for (std::uint32_t at = 0; at < sample.tree.nodes.size(); ++at) {
    const std::uint32_t own = whole(at);
    const WideNode& node = sample.tree.nodes[at];
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      if (child.block || whole(child.index) > 100) continue;
      EXPECT_EQ(cut.cut_nodes[child.index], own > 100);
      bottoms += own > 100;
    }
  }
  EXPECT_GT(bottoms, 20u);
}

// A node of a block that is too large together with its siblings has no other child. The bounds of
// the block are those that it had.
TEST(Treelets, GiveBlocksThatDoNotFitNodesOfTheirOwn) {
  const SampleTree small = build_sample(scattered(1500, 1.0), 4096);
  const SampleTree large = build_sample(scattered(1500, 1.0), 262144);
  EXPECT_EQ(small.tree.blocks.size(), large.tree.blocks.size());
  const RecordSlots slots{kNodeSlots, small.block_slots};
  std::size_t alone = 0;
  for (const WideNode& node : small.tree.nodes) {
    EXPECT_LE(slots_with_blocks(node, slots), bottom_slots(4096, slots));
    if (node.child_count > 1) continue;
    ++alone;
    const WideChild& child = node.children[0];
    EXPECT_TRUE(child.block);
    EXPECT_EQ(node.height, 1);
    EXPECT_TRUE(node.box.holds(child.box));
  }
  EXPECT_GT(alone, 20u);
  EXPECT_EQ(small.tree.nodes.size(), large.tree.nodes.size() + alone);
  for (const WideNode& node : large.tree.nodes) EXPECT_GT(node.child_count, 1);
}

using Key = std::pair<std::uint64_t, std::uint32_t>;

Key key_of(const PlannedPage& page) { return {page.octcode, page.ordinal}; }

// Checks the pages of a plan and the links between them.
class PlanCheck {
 public:
  explicit PlanCheck(const SampleTree& sample) : sample_(sample), plan_(sample.plan) {}

  void expect_each_record_once() const {
    std::vector<unsigned> nodes(sample_.tree.nodes.size()), blocks(sample_.tree.blocks.size());
    for (std::uint32_t number = 0; number < plan_.pages.size(); ++number) {
      const PlannedPage& page = plan_.pages[number];
      std::uint32_t slot = frame_head_slots(plan_.page_bytes);
      StoredLink link{number, 0};
      for (const std::uint32_t node : page.nodes) {
        ++nodes[node];
        EXPECT_EQ(plan_.node_links[node], link);
        ++link.record;
        slot += kNodeSlots;
      }
      link.record = 0;
      for (const std::uint32_t block : page.blocks) {
        ++blocks[block];
        EXPECT_EQ(plan_.block_links[block], link);
        ++link.record;
        slot += sample_.block_slots[block];
      }
      EXPECT_LE(slot * kSlotBytes, plan_.page_bytes);
    }
    EXPECT_TRUE(std::ranges::all_of(nodes, [](unsigned count) { return count == 1; }));
    EXPECT_TRUE(std::ranges::all_of(blocks, [](unsigned count) { return count == 1; }));
  }

  void expect_one_parent_page_each() const {
    std::vector<std::set<std::uint32_t>> parents(plan_.pages.size());
    std::set<StoredLink> roots = root_links();
    for (std::uint32_t at = 0; at < sample_.tree.nodes.size(); ++at) {
      const std::uint32_t own = plan_.node_links[at].page;
      const WideNode& node = sample_.tree.nodes[at];
      for (unsigned i = 0; i < node.child_count; ++i) {
        const WideChild& child = node.children[i];
        const StoredLink link =
            child.block ? plan_.block_links[child.index] : plan_.node_links[child.index];
        if (link.page == own) continue;
        EXPECT_FALSE(child.block);
        EXPECT_GT(link.page, own);
        parents[link.page].insert(own);
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
  std::set<StoredLink> root_links() const {
    std::set<StoredLink> roots;
    for (const PlannedPage& page : plan_.pages) {
      if (page.nodes.empty()) roots.insert(plan_.block_links[page.blocks[0]]);
      for (std::size_t i = 0; i < page.root_count; ++i)
        roots.insert(plan_.node_links[page.nodes[i]]);
    }
    return roots;
  }

  const SampleTree& sample_;
  const PagePlan& plan_;
};

TEST(PagePlan, IsConsistentForEveryMeshAndPageSize) {
  for (const Case& c : cases())
    for (std::uint32_t page_bytes = 4096; page_bytes <= 262144; page_bytes *= 2) {
      SCOPED_TRACE(std::string(c.name) + ", pages of " + std::to_string(page_bytes));
      const SampleTree sample = build_sample(c.soup, page_bytes);
      const PlanCheck check(sample);
      check.expect_each_record_once();
      check.expect_one_parent_page_each();
      check.expect_ascending_keys();
    }
}

TEST(PagePlan, GivesTheRootPageZero) {
  const SampleTree sample = build_sample(sphere(5));
  EXPECT_EQ(sample.plan.node_links[0], (StoredLink{0, 0}));
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
    if (page.root_count == 0) continue;
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
