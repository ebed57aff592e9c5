// Checks "Guarantees of the tree" and "Page keys" in the samples and in a file of many caps, as the
// independent reader decodes them.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/golden/samples.h"
#include "tests/golden/spec_tree.h"

namespace planetree::golden {
namespace {

/// A tree of a file: that of its surface or that of its caps.
struct FileTree {
  std::string name;
  std::function<std::vector<std::byte>()> bytes;
  SpecTree::Of of;
};

std::vector<FileTree> file_trees() {
  const auto bytes_of = [](const Sample& sample) {
    return [path = sample.ptree_path()] { return read_file(path); };
  };
  std::vector<FileTree> found;
  for (const Sample& sample : samples())
    found.push_back({sample_name({sample, 0}), bytes_of(sample), SpecTree::Of::kSurface});
  found.push_back({"caps_of_sheet", bytes_of(sheet_sample()), SpecTree::Of::kCaps});
  found.push_back({"caps_of_tube", bytes_of(tube_sample()), SpecTree::Of::kCaps});
  found.push_back({"caps_of_loose_sphere", build_loose_sphere, SpecTree::Of::kCaps});
  return found;
}

std::string tree_name(const testing::TestParamInfo<FileTree>& info) { return info.param.name; }

class SpecGuarantees : public testing::TestWithParam<FileTree> {
 protected:
  SpecGuarantees() : tree_(SpecFile(GetParam().bytes()), GetParam().of) {}

  // Calls look(page number, link, node) for every node.
  template <class Look>
  void each_node(Look look) const {
    for (std::uint32_t k = 0; k < tree_.pages().size(); ++k)
      for (const auto& [link, node] : tree_.pages()[k].nodes) look(k, link, node);
  }

  SpecTree tree_;
};

INSTANTIATE_TEST_SUITE_P(All, SpecGuarantees, testing::ValuesIn(file_trees()), tree_name);

TEST_P(SpecGuarantees, RecordsFormOneTree) {
  std::set<SpecLink> linked = {tree_.root_link()};
  each_node([&](std::uint32_t, SpecLink, const SpecNode& node) {
    for (const SpecChild& child : node.children)
      EXPECT_TRUE(linked.insert(child.link).second) << "linked twice";
  });
  std::size_t nodes = 0, blocks = 0;
  for (const SpecPage& page : tree_.pages()) {
    nodes += page.nodes.size();
    blocks += page.blocks.size();
    for (const auto& [link, node] : page.nodes) EXPECT_TRUE(linked.contains(link));
    for (const auto& [link, block] : page.blocks) EXPECT_TRUE(linked.contains(link));
  }
  EXPECT_EQ(linked.size(), nodes + blocks);
  EXPECT_EQ(tree_.counts().nodes, nodes);
  EXPECT_EQ(tree_.counts().blocks, blocks);
}

TEST_P(SpecGuarantees, LinksBetweenPagesLeadDownToRoots) {
  std::map<std::uint32_t, std::uint32_t> parent_of;
  each_node([&](std::uint32_t page, SpecLink, const SpecNode& node) {
    for (const SpecChild& child : node.children) {
      const std::uint32_t below = tree_.page_of(child.link);
      EXPECT_EQ(tree_.pages().at(below).roots.contains(child.link), below != page);
      if (below == page) continue;
      EXPECT_GT(below, page);
      EXPECT_EQ(parent_of.emplace(below, page).first->second, page) << "two parent pages";
    }
  });
  EXPECT_EQ(parent_of.size(), tree_.pages().size() - 1);
  EXPECT_EQ(tree_.page_of(tree_.root_link()), 0u);
  EXPECT_EQ(tree_.pages()[0].roots, std::set{tree_.root_link()});
}

TEST_P(SpecGuarantees, BoxesNestWithinAndAcrossPages) {
  each_node([&](std::uint32_t, SpecLink, const SpecNode& node) {
    for (const SpecChild& child : node.children) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_LE(node.box.lower[axis], child.box.lower[axis]);
        EXPECT_LE(child.box.lower[axis], child.box.upper[axis]);
        EXPECT_LE(child.box.upper[axis], node.box.upper[axis]);
      }
      if (SpecTree::is_block(child.link)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_LE(child.box.lower[axis], tree_.node(child.link).box.lower[axis]);
        EXPECT_LE(tree_.node(child.link).box.upper[axis], child.box.upper[axis]);
      }
    }
  });
}

// All corners below a child, relative to the centre with one rounding.
std::vector<SpecPoint> corners_below(const SpecTree& tree, SpecLink link) {
  std::vector<SpecPoint> corners;
  const SpecPoint& centre = tree.header().centre;
  for (const SpecTriangle& triangle : tree.triangles(link))
    for (const SpecPoint& x : triangle.corners)
      corners.push_back({x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]});
  return corners;
}

TEST_P(SpecGuarantees, BoxesEncloseWithoutSlack) {
  each_node([&](std::uint32_t, SpecLink, const SpecNode& node) {
    for (const SpecChild& child : node.children)
      for (const SpecPoint& d : corners_below(tree_, child.link))
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_LE(static_cast<double>(child.box.lower[axis]), d[axis]);
          EXPECT_GE(static_cast<double>(child.box.upper[axis]), d[axis]);
        }
  });
}

// Rounding in double is about 2^-29 of the slack that is tested.
void expect_enclosed(const SpecDisc& disc, const SpecPoint& d) {
  const double n[3] = {disc.normal[0], disc.normal[1], disc.normal[2]};
  double e[3];
  for (std::size_t axis = 0; axis < 3; ++axis)
    e[axis] = d[axis] - static_cast<double>(disc.middle[axis]);
  const double height = n[0] * e[0] + n[1] * e[1] + n[2] * e[2];
  const double from_axis =
      std::hypot(e[1] * n[2] - e[2] * n[1], e[2] * n[0] - e[0] * n[2], e[0] * n[1] - e[1] * n[0]);
  const double slack = 8 * 0x1p-24 * 32000 * static_cast<double>(disc.unit);
  EXPECT_LE(static_cast<double>(disc.slab_lower) + slack, height);
  EXPECT_GE(static_cast<double>(disc.slab_upper) - slack, height);
  EXPECT_GE(static_cast<double>(disc.radius) - slack, from_axis);
  EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1, 4 * 0x1p-24);
}

TEST_P(SpecGuarantees, DiscsEncloseWithTheirSlack) {
  each_node([&](std::uint32_t, SpecLink, const SpecNode& node) {
    for (const SpecChild& child : node.children)
      for (const SpecPoint& d : corners_below(tree_, child.link)) expect_enclosed(child.disc, d);
  });
}

TEST_P(SpecGuarantees, RootBoxIsTight) {
  const SpecLink root = tree_.root_link();
  if (SpecTree::is_block(root)) return;  // a block has no box of its own
  const std::vector<SpecPoint> corners = corners_below(tree_, root);
  const SpecBox& box = tree_.node(root).box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double least = INFINITY, greatest = -INFINITY;
    for (const SpecPoint& d : corners) {
      least = std::min(least, d[axis]);
      greatest = std::max(greatest, d[axis]);
    }
    EXPECT_LE(static_cast<double>(box.lower[axis]), least);
    EXPECT_GT(static_cast<double>(std::nextafter(box.lower[axis], INFINITY)), least);
    EXPECT_GE(static_cast<double>(box.upper[axis]), greatest);
    EXPECT_LT(static_cast<double>(std::nextafter(box.upper[axis], -INFINITY)), greatest);
  }
}

TEST_P(SpecGuarantees, HeightsAreThoseOfTheLongestPath) {
  each_node([&](std::uint32_t, SpecLink, const SpecNode& node) {
    unsigned below = 0;
    for (const SpecChild& child : node.children)
      if (!SpecTree::is_block(child.link)) below = std::max(below, tree_.node(child.link).height);
    EXPECT_EQ(node.height, below + 1);
    EXPECT_GE(node.children.size(), 1u);
    EXPECT_LE(node.children.size(), 8u);
  });
  const SpecLink root = tree_.root_link();
  EXPECT_EQ(tree_.counts().height, SpecTree::is_block(root) ? 0 : tree_.node(root).height);
}

TEST_P(SpecGuarantees, BlocksAreSmallAndAscend) {
  for (const SpecPage& page : tree_.pages())
    for (const auto& [link, block] : page.blocks) {
      EXPECT_GE(block.triangles.size(), 1u);
      EXPECT_LE(block.triangles.size(), 16u);
      EXPECT_LE(block.vertex_count, 48u);
      for (std::size_t i = 1; i < block.triangles.size(); ++i)
        EXPECT_LT(block.triangles[i - 1].id, block.triangles[i].id);
    }
}

TEST_P(SpecGuarantees, VerticesAreNumberedByFirstUse) {
  for (const SpecPage& page : tree_.pages()) {
    std::map<SpecPoint, std::uint32_t> number_of;
    for (const auto& [link, block] : page.blocks) {
      std::set<std::uint32_t> used;
      for (const SpecTriangle& triangle : block.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
          const auto next = static_cast<std::uint32_t>(number_of.size());
          const auto at = number_of.emplace(triangle.corners[k], next).first;
          EXPECT_EQ(triangle.page_vertex[k], at->second);
          used.insert(triangle.page_vertex[k]);
        }
      EXPECT_EQ(block.vertex_count, used.size());
    }
  }
}

// Bits from the coarsest level down: z, y, x of each level.
std::string morton_bits(const SpecHeader& header, const SpecTriangle& triangle) {
  std::array<std::uint32_t, 3> cell{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double least = INFINITY, greatest = -INFINITY;
    for (const SpecPoint& corner : triangle.corners) {
      least = std::min(least, corner[axis]);
      greatest = std::max(greatest, corner[axis]);
    }
    const double lower = std::ldexp(header.core_lower[axis], header.scale_exponent);
    const double at = ((least + greatest) * 0.5 - lower) * 0x1p18;
    cell[axis] = static_cast<std::uint32_t>(std::clamp(at, 0.0, 524287.0));
  }
  std::string bits;
  for (unsigned level = 19; level-- > 0;)
    for (const std::size_t axis : {2u, 1u, 0u}) bits += (cell[axis] >> level & 1) != 0 ? '1' : '0';
  return bits;
}

std::uint64_t octcode_below(const SpecTree& tree, SpecLink link) {
  const std::vector<SpecTriangle> triangles = tree.triangles(link);
  std::string prefix = morton_bits(tree.header(), triangles.front());
  for (const SpecTriangle& triangle : triangles) {
    const std::string bits = morton_bits(tree.header(), triangle);
    prefix.erase(std::ranges::mismatch(prefix, bits).in1, prefix.end());
  }
  const std::uint64_t length = prefix.size();
  prefix.resize(57, '0');
  return (length / 3) << 59 | std::stoull(prefix, nullptr, 2) << 2 | length % 3;
}

TEST_P(SpecGuarantees, PageKeysNameTheirFirstSubtree) {
  for (const SpecPage& page : tree_.pages()) {
    std::uint64_t least = ~std::uint64_t{0};
    for (const SpecLink root : page.roots) least = std::min(least, octcode_below(tree_, root));
    EXPECT_EQ(page.octcode, least);
  }
}

TEST_P(SpecGuarantees, OrdinalsCountPagesOfOneCell) {
  std::map<std::uint64_t, std::uint32_t> pages;
  for (const SpecPage& page : tree_.pages()) EXPECT_EQ(page.ordinal, pages[page.octcode]++);
}

}  // namespace
}  // namespace planetree::golden
