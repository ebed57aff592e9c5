#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "octree/builder/tree/area_split.h"
#include "octree/builder/tree/binary_tree.h"
#include "octree/builder/tree/disc_fit.h"
#include "octree/builder/tree/float_rounding.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/traversal/bounds.h"
#include "tests/octree/support/sample_tree.h"

// Properties of binary and wide trees that hold for any mesh.
namespace planetree::octree {
namespace {

struct Case {
  const char* name;
  Soup soup;
};

std::vector<Case> cases() {
  return {{"one triangle", repeated(1)},
          {"a full block", repeated(16)},
          {"one too many for a block", repeated(17)},
          {"a triangle many times", repeated(1000)},
          {"sphere", sphere(4)},
          {"sheet", height_field(30)},
          {"long triangles", scattered(700, 1.0)},
          {"small triangles", scattered(700, 1e-4)}};
}

bool encloses(const FloatBox& outer, const FloatBox& inner) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (outer.lower[axis] > inner.lower[axis] || outer.upper[axis] < inner.upper[axis])
      return false;
  return true;
}

FloatBox box_of(const SampleTree& sample, std::uint32_t begin, std::uint32_t end) {
  FloatBox box = empty_box();
  for (std::uint32_t i = begin; i < end; ++i)
    for (const Point& corner : sample.mesh.corners(sample.keys[i].position))
      extend(box, corner - sample.centre);
  return box;
}

void expect_permutation(const std::vector<MortonKey>& keys) {
  std::vector<bool> seen(keys.size());
  for (const MortonKey& key : keys) seen[key.position] = true;
  EXPECT_EQ(std::count(seen.begin(), seen.end(), false), 0);
}

TEST(BinaryTree, SplitsTrianglesUntilTheyFitABlock) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SampleTree sample = build_sample(c.soup);
    expect_permutation(sample.keys);
    const std::vector<BinaryNode>& nodes = sample.binary;
    EXPECT_EQ(nodes[0].begin, 0u);
    EXPECT_EQ(nodes[0].end, c.soup.size());
    for (std::uint32_t at = 0; at < nodes.size(); ++at) {
      const BinaryNode& node = nodes[at];
      EXPECT_EQ(node.leaf(), node.count() <= kMaxBlockTriangles);
      EXPECT_GE(node.count(), 1u);
      if (node.leaf()) continue;
      EXPECT_GT(node.left, at);
      EXPECT_GT(node.right, at);
      EXPECT_EQ(nodes[node.left].begin, node.begin);
      EXPECT_EQ(nodes[node.left].end, nodes[node.right].begin);
      EXPECT_EQ(nodes[node.right].end, node.end);
    }
  }
}

TEST(BinaryTree, BoxesAreTight) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SampleTree sample = build_sample(c.soup);
    for (const BinaryNode& node : sample.binary) {
      const FloatBox expected = box_of(sample, node.begin, node.end);
      EXPECT_EQ(node.box.lower, expected.lower);
      EXPECT_EQ(node.box.upper, expected.upper);
    }
  }
}

TEST(BinaryTree, SplitsLargeRangesByCode) {
  const SampleTree sample = build_sample(sphere(5));
  const std::vector<MortonKey> sorted = keys_of(sample.mesh);
  for (const BinaryNode& node : sample.binary) {
    if (node.count() <= kMaxAreaSplit) continue;
    // All codes on the left are below all codes on the right.
    const std::uint32_t middle = sample.binary[node.left].end;
    EXPECT_LT(sorted[middle - 1].code, sorted[middle].code);
  }
}

TEST(WideTree, IsASingleBlockForSixteenTriangles) {
  const SampleTree sample = build_sample(repeated(16));
  EXPECT_TRUE(sample.tree.nodes.empty());
  ASSERT_EQ(sample.tree.blocks.size(), 1u);
  EXPECT_EQ(sample.tree.blocks[0].end, 16u);
}

TEST(WideTree, PutsEveryTriangleInOneBlockInOrder) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SampleTree sample = build_sample(c.soup);
    std::uint32_t next = 0;
    for (const WideBlock& block : sample.tree.blocks) {
      EXPECT_EQ(block.begin, next);
      EXPECT_GT(block.end, block.begin);
      EXPECT_LE(block.end - block.begin, kMaxBlockTriangles);
      next = block.end;
    }
    EXPECT_EQ(next, c.soup.size());
  }
}

TEST(WideTree, NamesEveryRecordOnceInPreorder) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const WideTree tree = build_sample(c.soup).tree;
    std::vector<unsigned> node_parents(tree.nodes.size()), block_parents(tree.blocks.size());
    for (std::uint32_t at = 0; at < tree.nodes.size(); ++at) {
      const WideNode& node = tree.nodes[at];
      // A node of one child was made for a block, see part_blocks().
      EXPECT_GE(node.child_count, node.children[0].block ? 1 : 2);
      EXPECT_LE(node.child_count, kFanOut);
      for (unsigned i = 0; i < node.child_count; ++i) {
        const WideChild& child = node.children[i];
        ++(child.block ? block_parents : node_parents)[child.index];
        if (!child.block) {
          EXPECT_GT(child.index, at);
        }
        if (i > 0) {
          EXPECT_EQ(child.begin, node.children[i - 1].end);
        }
      }
    }
    if (tree.nodes.empty()) continue;
    EXPECT_EQ(node_parents[0], 0u);
    EXPECT_EQ(std::count(node_parents.begin() + 1, node_parents.end(), 1u),
              static_cast<std::ptrdiff_t>(tree.nodes.size() - 1));
    EXPECT_EQ(std::count(block_parents.begin(), block_parents.end(), 1u),
              static_cast<std::ptrdiff_t>(tree.blocks.size()));
  }
}

TEST(WideTree, StatesItsHeights) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const WideTree tree = build_sample(c.soup).tree;
    for (const WideNode& node : tree.nodes) {
      unsigned below = 0;
      for (unsigned i = 0; i < node.child_count; ++i)
        if (!node.children[i].block)
          below = std::max<unsigned>(below, tree.nodes[node.children[i].index].height);
      EXPECT_EQ(node.height, below + 1);
      EXPECT_LE(node.height, kMaxHeight);
    }
  }
}

TEST(WideTree, DecodesToBoxesThatNestAndEnclose) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SampleTree sample = build_sample(c.soup);
    for (const WideNode& node : sample.tree.nodes)
      for (unsigned i = 0; i < node.child_count; ++i) {
        const WideChild& child = node.children[i];
        const FloatBox decoded = unpack_box(node.box, child.packed);
        EXPECT_EQ(decoded.lower, child.box.lower);
        EXPECT_EQ(decoded.upper, child.box.upper);
        EXPECT_TRUE(encloses(node.box, child.box));
        EXPECT_TRUE(encloses(child.box, child.true_box));
        EXPECT_TRUE(encloses(child.true_box, box_of(sample, child.begin, child.end)));
        if (!child.block) {
          EXPECT_EQ(sample.tree.nodes[child.index].box.lower, child.box.lower);
        }
      }
  }
}

TEST(WideTree, ChildBoxesAreTightWithinOneStep) {
  const SampleTree sample = build_sample(sphere(4));
  for (const WideNode& node : sample.tree.nodes)
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float step = (node.box.upper[axis] - node.box.lower[axis]) * (1.01f / 255);
        EXPECT_LE(child.true_box.lower[axis] - child.box.lower[axis], step);
        EXPECT_LE(child.box.upper[axis] - child.true_box.upper[axis], step);
      }
    }
}

// The specification's margin of 8 r 2^-24, evaluated in double.
TEST(DiscFit, EnclosesEveryVertexWithItsMargin) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SampleTree sample = build_sample(c.soup);
    for (const WideNode& node : sample.tree.nodes)
      for (unsigned i = 0; i < node.child_count; ++i) {
        const WideChild& child = node.children[i];
        const Disc disc = unpack_disc(child.box, child.packed);
        const auto centre = child.box.centre();
        const Point middle(centre[0], centre[1], centre[2]);
        const Point normal(disc.normal[0], disc.normal[1], disc.normal[2]);
        const double margin =
            8 * 0x1p-24 * std::sqrt(double{child.box.diagonal_squared()}) / 2 * (1 - 1e-6);
        for (std::uint32_t k = child.begin; k < child.end; ++k)
          for (const Point& corner : sample.mesh.corners(sample.keys[k].position)) {
            const Point from = corner - sample.centre - middle;
            ASSERT_LE(disc.slab_lower + margin, normal.dot(from));
            ASSERT_GE(disc.slab_upper - margin, normal.dot(from));
            ASSERT_LE(from.cross(normal).norm(), disc.radius - margin);
          }
      }
  }
}

TEST(DiscFit, LiesAlongAFlatSurface) {
  // A flat grid in an oblique plane: its discs are far thinner than its boxes.
  Soup soup;
  for (const auto& t : height_field(20)) {
    auto& flat = soup.emplace_back(t);
    for (Vec3& corner : flat) corner.z = corner.x * 0.5 + corner.y * 0.25;
  }
  const SampleTree sample = build_sample(soup);
  for (const WideNode& node : sample.tree.nodes)
    for (unsigned i = 0; i < node.child_count; ++i) {
      const Disc disc = unpack_disc(node.children[i].box, node.children[i].packed);
      const float diagonal = std::sqrt(node.children[i].box.diagonal_squared());
      EXPECT_LT(disc.slab_upper - disc.slab_lower, 0.001f * diagonal);
    }
}

TEST(DiscFit, EnclosesSubtreesTooLargeForTheirVertices) {
  const SampleTree sample = build_sample(height_field(190), 65536);
  const WideNode& root = sample.tree.nodes[0];
  const SampleMesh& mesh = sample.mesh;
  // The root's children have too few vertices, so a node is added above the root.
  WideTree tree = sample.tree;
  WideNode above = root;
  above.child_count = 1;
  above.children[0].block = false;
  above.children[0].index = 0;
  above.children[0].begin = 0;
  above.children[0].end = mesh.size();
  above.children[0].box = root.box;
  ASSERT_GT(above.children[0].count(), 1u << 16);
  tree.nodes.push_back(above);
  fit_discs(mesh, sample.vertices, sample.centre, sample.keys, tree);
  const Disc disc = unpack_disc(root.box, tree.nodes.back().children[0].packed);
  const auto centre = root.box.centre();
  const Point normal(disc.normal[0], disc.normal[1], disc.normal[2]);
  for (std::uint32_t i = 0; i < mesh.size(); i += 7)
    for (const Point& corner : mesh.corners(i)) {
      const Point from = corner - sample.centre - Point(centre[0], centre[1], centre[2]);
      ASSERT_LE(disc.slab_lower, normal.dot(from));
      ASSERT_GE(disc.slab_upper, normal.dot(from));
      ASSERT_LE(from.cross(normal).norm(), disc.radius);
    }
}

}  // namespace
}  // namespace planetree::octree
