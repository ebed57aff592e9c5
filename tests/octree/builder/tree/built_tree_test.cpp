#include "octree/builder/tree/built_tree.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "octree/builder/mask/tree_frames.h"
#include "octree/traversal/link_resolver.h"
#include "octree/traversal/tree_view.h"
#include "octree/traversal/tree_walk.h"
#include "tests/octree/builder/chunked_tree.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {
namespace {

struct BuiltTreeCase {
  const char* name;
  Soup soup;
  std::uint64_t chunk_triangles;
};

std::vector<BuiltTreeCase> built_cases() {
  return {{"one patch", sphere(4), 1 << 20},
          {"patches", sphere(4), 40},
          {"doubles", scattered(900, 0.1), 60},
          {"a block", sphere(0), 100},
          {"in one place", repeated(300), 50}};
}

// Each triangle is found once, and the number of records is as reported.
TEST(BuiltTree, HoldsTheTrianglesOfAllChunks) {
  for (const BuiltTreeCase& c : built_cases()) {
    SCOPED_TRACE(c.name);
    const ChunkedTree sample(c.soup, c.chunk_triangles);
    EXPECT_EQ(sample.above.chunks.size() > 1, c.soup.size() > c.chunk_triangles);
    ASSERT_TRUE(sample.tree->check());
    const TreeInfo tree = sample.tree->info();
    TreeFrames frames(sample.tree.get());
    TraversalStats work;
    std::set<std::uint64_t> found;
    std::set<std::uint32_t> links;
    EXPECT_TRUE(BoxWalk(tree, tree.box_lower, tree.box_upper, frames.reader(), work)
                    .run(~std::uint64_t{0}, [&](const BlockView& block, std::uint32_t link) {
                      EXPECT_TRUE(links.insert(link).second);
                      EXPECT_LT(LinkFormat(tree.page_bytes, tree.shape.links).page(link),
                                sample.tree->pages().size());
                      for (unsigned i = 0; i < block.triangle_count(); ++i)
                        EXPECT_TRUE(found.insert(block.id(i)).second);
                    }));
    EXPECT_EQ(found.size(), c.soup.size());
    EXPECT_EQ(*found.rbegin(), c.soup.size() - 1);
    EXPECT_EQ(work.nodes, sample.tree->node_count());
    EXPECT_EQ(work.blocks, sample.tree->block_count());
    EXPECT_EQ(tree.record_count, work.nodes + work.blocks);
    EXPECT_TRUE(frames.state());
  }
}

TEST(BuiltTree, HeightIsThatOfTheRoot) {
  for (const BuiltTreeCase& c : built_cases()) {
    SCOPED_TRACE(c.name);
    const ChunkedTree sample(c.soup, c.chunk_triangles);
    const TreeInfo tree = sample.tree->info();
    TreeFrames frames(sample.tree.get());
    TraversalStats work;
    const std::byte* root = LinkResolver(tree, frames.reader()).find(tree.root_link, work);
    ASSERT_NE(root, nullptr);
    const bool block = LinkFormat::is_leaf(tree.root_link);
    EXPECT_EQ(sample.tree->height(), block ? 0u : reinterpret_cast<const Node*>(root)->height);
    EXPECT_EQ(block, c.soup.size() <= kMaxBlockTriangles);
  }
}

// The steps of a box as large as that of the strays would resolve nothing of the core.
TEST(BuiltTree, KeepsTheCoreApartFromStrays) {
  Soup soup = sphere(4);
  soup.push_back({Vec3{1e9, 0, 0}, Vec3{1e9, 1, 0}, Vec3{1e9, 0, 1}});
  soup.push_back({Vec3{-1e9, 0, 0}, Vec3{-1e9, 1, 0}, Vec3{-1e9, 0, 1}});
  const ChunkedTree sample(soup, 200);
  ASSERT_GT(sample.above.chunks.size(), 5u);
  const TreeInfo tree = sample.tree->info();
  EXPECT_TRUE(tree.has_strays);
  TreeFrames frames(sample.tree.get());
  TraversalStats work;
  const PageReader reader = frames.reader();
  LinkResolver records(tree, reader);
  const std::byte* found = records.find(tree.root_link, work);
  ASSERT_NE(found, nullptr);
  const Node root = *reinterpret_cast<const Node*>(found);
  ASSERT_EQ(root.child_count, 2);
  found = records.find(root.link[0], work);
  ASSERT_NE(found, nullptr);
  EXPECT_NE(records.page(), 0u);
  const FloatBox box = reinterpret_cast<const Node*>(found)->box;
  const FloatBox core = ChunkedTree(sphere(4), 1 << 20).chunks[0].box;
  EXPECT_EQ(box.lower, core.lower);
  EXPECT_EQ(box.upper, core.upper);
}

TEST(BuiltTree, ReportsTheModelsBox) {
  const ChunkedTree sample(sphere(3), 40);
  const TreeInfo tree = sample.tree->info();
  EXPECT_EQ(tree.box_lower, sample.mesh.lower());
  EXPECT_EQ(tree.box_upper, sample.mesh.upper());
  EXPECT_EQ(tree.centre, sample.mesh.frame.centre());
  EXPECT_EQ(tree.page_bytes, 4096u);
}

}  // namespace
}  // namespace planetree::octree
