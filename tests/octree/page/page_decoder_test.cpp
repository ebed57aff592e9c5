#include "octree/page/page_decoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "octree/nearest/nearest.h"
#include "octree/page/block_table.h"
#include "octree/page/frame.h"
#include "tests/octree/page/raw_page.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

struct Case {
  const char* name;
  Soup soup;
  std::uint32_t page_bytes;
  std::uint64_t first_index = 0;
};

// Rounds corners to float. Scattered triangles share no vertex before or after.
Soup rounded(Soup soup) {
  for (auto& triangle : soup)
    for (Vec3& corner : triangle)
      corner = {double{static_cast<float>(corner.x)}, double{static_cast<float>(corner.y)},
                double{static_cast<float>(corner.z)}};
  return soup;
}

std::vector<Case> cases() {
  return {{"sphere in small pages", sphere(4), 4096},
          {"sphere in large pages", sphere(4), 262144},
          {"one triangle", repeated(1), 4096},
          {"one block", repeated(16), 4096},
          {"a triangle many times", repeated(700), 4096},
          {"scattered", rounded(scattered(900, 0.05)), 4096},
          {"scattered float64", scattered(900, 0.05), 4096},
          {"scattered float64 in 16 KiB", scattered(900, 0.05), 16384},
          {"wide ids", sphere(3), 4096, std::uint64_t{5} << 32},
          {"float64 and wide ids", scattered(600, 0.3), 8192, std::uint64_t{0xffffff00}}};
}

using Found = std::map<std::uint64_t, std::array<std::array<double, 3>, 3>>;

// Walks decoded pages from the root, as a reader does.
class Walk {
 public:
  Walk(const SampleTree& sample, const SamplePages& pages)
      : sample_(sample), pages_(pages), links_(sample.plan.page_bytes, sample.shape.links) {
    follow(tree_info(sample).root_link, kMaxHeight + 1);
  }

  Found found;
  std::size_t nodes = 0, blocks = 0;

 private:
  void follow(std::uint32_t link, unsigned parent_height) {
    const std::byte* record = pages_.record(links_, link);
    if (LinkFormat::is_leaf(link))
      visit(BlockView(record, sample_.shape));
    else
      visit(*reinterpret_cast<const Node*>(record), parent_height);
  }

  void visit(const Node& node, unsigned parent_height) {
    ++nodes;
    EXPECT_LT(node.height, parent_height);
    for (unsigned child = 0; child < node.child_count; ++child) {
      const FloatBox box = child_box(node, child);
      EXPECT_TRUE(node.box.holds(box));
      EXPECT_LE(box.lower[0], box.upper[0]);
      follow(node.link[child], node.height);
    }
  }

  void visit(const BlockView& block) {
    ++blocks;
    for (unsigned i = 0; i < block.triangle_count(); ++i) {
      const Triangle triangle = block.triangle(i);
      auto& corners = found[block.id(i)];
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = {triangle[k].x(), triangle[k].y(), triangle[k].z()};
        EXPECT_LE((block.vertex(block.header().corners(i)[k]) - block.vertex(0)).norm(),
                  double{block.header().extent});
      }
      if (i > 0) {
        EXPECT_LT(block.id(i - 1), block.id(i));
      }
    }
    // Lanes beyond the last triangle, which the wide kernels read, repeat it.
    for (unsigned i = block.triangle_count(); i < kMaxBlockTriangles; ++i)
      EXPECT_EQ(block.header().corners(i), block.header().corners(block.triangle_count() - 1));
  }

  const SampleTree& sample_;
  const SamplePages& pages_;
  LinkFormat links_;
};

TEST(PageDecoder, GivesBackEveryTriangleBitForBit) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const SampleTree sample = build_sample(c.soup, c.page_bytes, c.first_index);
    const SamplePages pages(sample);
    const Walk walk(sample, pages);
    EXPECT_EQ(walk.nodes, sample.tree.nodes.size());
    EXPECT_EQ(walk.blocks, sample.tree.blocks.size());
    ASSERT_EQ(walk.found.size(), c.soup.size());
    for (std::size_t i = 0; i < c.soup.size(); ++i) {
      const auto found = walk.found.find(c.first_index + i);
      ASSERT_NE(found, walk.found.end()) << i;
      const double scale = std::ldexp(1.0, sample.mesh.frame.scale_exponent);
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& corner = c.soup[i][k];
        const std::array<double, 3> expected{corner.x * scale, corner.y * scale, corner.z * scale};
        EXPECT_EQ(found->second[k], expected) << i;
      }
    }
  }
}

TEST(PageDecoder, CoversFloat64WideIdsAndManyPages) {
  bool float64 = false, wide_ids = false, many_pages = false;
  for (const Case& c : cases()) {
    const SampleTree sample = build_sample(c.soup, c.page_bytes, c.first_index);
    float64 |= sample.shape.float64;
    wide_ids |= sample.shape.wide_ids;
    many_pages |= sample.plan.pages.size() > 10;
  }
  EXPECT_TRUE(float64 && wide_ids && many_pages);
}

// Number of links that lead from `page` to other pages, by the page plan.
std::size_t links_out_of(const SampleTree& sample, std::uint32_t page) {
  std::size_t count = 0;
  for (const std::uint32_t at : sample.plan.pages[page].nodes) {
    const WideNode& node = sample.tree.nodes[at];
    for (unsigned i = 0; i < node.child_count; ++i) {
      const WideChild& child = node.children[i];
      const auto& of_kind = child.block ? sample.plan.block_links : sample.plan.node_links;
      if (of_kind[child.index].page != page) ++count;
    }
  }
  return count;
}

TEST(PageDecoder, WritesFrameContentsToTheHeader) {
  const SampleTree sample = build_sample(sphere(4), 4096);
  const SamplePages pages(sample);
  EXPECT_GT(pages.frame(0).header().page_link_count, 0);
  EXPECT_EQ(pages.frame(static_cast<std::uint32_t>(pages.size() - 1)).header().page_link_count, 0);
  for (std::uint32_t page = 0; page < pages.size(); ++page) {
    const FrameHeader& header = pages.frame(page).header();
    const PlannedPage& planned = sample.plan.pages[page];
    EXPECT_EQ(header.page_number, page);
    EXPECT_EQ(header.octcode, planned.octcode);
    EXPECT_EQ(header.ordinal, planned.ordinal);
    EXPECT_EQ(header.node_count, planned.nodes.size());
    EXPECT_EQ(header.block_count, planned.blocks.size());
    EXPECT_EQ(header.page_link_count, links_out_of(sample, page));
    EXPECT_LE(header.used_bytes, sample.plan.page_bytes);
  }
}

TEST(PageDecoder, ListsTheSlotsOfBlocks) {
  for (const std::uint32_t page_bytes : {4096u, 65536u}) {
    const SampleTree sample = build_sample(sphere(4), page_bytes);
    const SamplePages pages(sample);
    for (std::uint32_t page = 0; page < pages.size(); ++page) {
      const BlockTable table(pages.frame(page).data());
      std::uint32_t slot = pages.frame(page).header().first_block_slot;
      std::uint16_t number = 0;
      for (const std::uint32_t block : sample.plan.pages[page].blocks) {
        EXPECT_EQ(table.slot(number), slot);
        EXPECT_EQ(table.number_at(slot), number++);
        EXPECT_EQ(table.number_at(slot + 1), std::nullopt);
        slot += sample.block_slots[block];
      }
      for (std::uint32_t none = number; none < max_page_blocks(page_bytes); ++none)
        EXPECT_EQ(table.slot(none), 0u);
      EXPECT_EQ(table.number_at(slot), std::nullopt);
      EXPECT_EQ(table.number_at(0), std::nullopt);
    }
  }
}

TEST(PageDecoder, IgnoresOldFrameContents) {
  const SampleTree sample = build_sample(sphere(3), 262144);
  SamplePages pages(sample);
  SampleFrame other(sample.plan.page_bytes);
  std::ranges::fill(other.bytes(), std::byte{0xee});
  ASSERT_TRUE(decode_page(pages.raw(0), page_info(sample, 0), other.bytes()));
  const std::size_t used = other.header().used_bytes;
  // Padding inside a record may keep old bytes; triangles may not.
  const BlockView first(other.data() + other.header().first_block_slot * kSlotBytes, sample.shape);
  const BlockView same(pages.frame(0).data() + other.header().first_block_slot * kSlotBytes,
                       sample.shape);
  EXPECT_EQ(first.triangle(0)[1], same.triangle(0)[1]);
  EXPECT_EQ(used, pages.frame(0).header().used_bytes);
  EXPECT_EQ(other.bytes()[used], std::byte{0xee});
}

// Changes each byte in turn: the page is refused, or a query on what was decoded stays within its
// bounds. The sanitizers report anything worse.
TEST(PageDecoder, SurvivesEveryByteChanged) {
  const SampleTree sample = build_sample(sphere(2), 8192);
  SamplePages pages(sample);
  SampleFrame frame(sample.plan.page_bytes);
  const TreeInfo info = tree_info(sample);
  const PageReader reader{&frame, [](void* context, std::uint32_t page) noexcept {
                            const auto& only = *static_cast<SampleFrame*>(context);
                            return page == 0 ? only.data() : nullptr;
                          }};
  std::size_t accepted = 0;
  for (std::size_t at = 0; at < pages.raw(0).size(); ++at)
    for (const unsigned change : {0x01u, 0x80u, 0xffu}) {
      std::vector<std::byte> raw = pages.raw(0);
      raw[at] ^= static_cast<std::byte>(change);
      if (!decode_page(raw, page_info(sample, 0), frame.bytes())) continue;
      ++accepted;
      TraversalStats work;
      const NearestAnswer answer = nearest(info, Point(0.3, 0.7, -2), {}, reader, work);
      EXPECT_FALSE(std::isnan(answer.distance));
      EXPECT_LE(answer.lower, answer.upper);
      EXPECT_LE(work.nodes + work.blocks, info.record_count);
    }
  EXPECT_GT(accepted, 100u);
}

}  // namespace
}  // namespace planetree::octree
