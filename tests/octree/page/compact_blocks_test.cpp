#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "octree/page/frame.h"
#include "tests/octree/support/each_block.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

// Number of compact and of other blocks of a soup. Also checks every triangle read back.
struct Forms {
  std::size_t compact = 0, with_far_indices = 0, with_many_vertices = 0;
};

Forms forms_of(const Soup& soup) {
  const SampleTree sample = build_sample(soup, 65536);
  std::vector<Triangle> expected(soup.size());
  for (std::uint32_t i = 0; i < sample.mesh.size(); ++i)
    expected[sample.mesh.index(i)] = sample.mesh.corners(i);
  Forms forms;
  const LinkFormat links = LinkFormat::numbered(sample.plan.page_bytes);
  std::uint32_t next = 0;  // behind the block before
  std::vector<bool> found(soup.size());
  each_block(sample, SamplePages(sample), [&](const BlockView& block, std::uint32_t link) {
    const BlockHeader& header = block.header();
    const unsigned count = block.triangle_count();
    const bool near = block.id(count - 1) - block.id(0) <= 65535;
    EXPECT_EQ(header.compact(), near && header.vertex_count() <= 16);
    if (links.page(link) == links.page(next)) {
      EXPECT_EQ(link, next);
    }
    next = link + 1;
    ++(header.compact() ? forms.compact : near ? forms.with_many_vertices : forms.with_far_indices);
    for (unsigned i = 0; i < count; ++i) {
      const auto id = static_cast<std::size_t>(block.id(i));
      ASSERT_LT(id, soup.size());
      EXPECT_FALSE(found[id]);
      found[id] = true;
      EXPECT_EQ(block.triangle(i), expected[id]) << id;
    }
  });
  EXPECT_EQ(std::count(found.begin(), found.end(), false), 0);
  return forms;
}

// Triangles that are neighbours in the first mesh have close indices; in the second, distant ones.
TEST(CompactBlocks, HaveFewVerticesAndCloseIndices) {
  const Soup near = sphere(7);
  ASSERT_GT(near.size(), 100000u);
  const Forms of_near = forms_of(near);
  EXPECT_GT(of_near.compact, 4000u);
  EXPECT_GT(of_near.with_many_vertices, 0u);

  Soup far;
  const std::size_t half = near.size() / 2;
  for (std::size_t i = 0; i < half; ++i) far.push_back(near[2 * i]);
  for (std::size_t i = 0; i < near.size() - half; ++i)
    far.push_back(near[std::min(2 * i + 1, near.size() - 1)]);
  const Forms of_far = forms_of(far);
  EXPECT_GT(of_far.with_far_indices, 1000u);
}

}  // namespace
}  // namespace planetree::octree
