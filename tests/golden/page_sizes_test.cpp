// The page size decides which records share a page, and nothing else.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "planetree/planetree.h"
#include "tests/golden/samples.h"
#include "tests/golden/spec_tree.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::golden {
namespace {

constexpr std::uint32_t kPageSizes[] = {4096, 8192, 16384, 32768, 65536, 131072, 262144};

std::vector<std::byte> sphere_with_pages(std::uint32_t page_bytes) {
  return build_bytes(sphere_sample().mesh_path(), page_bytes, 2);
}

std::vector<ClosestPoint> answer(const std::vector<std::byte>& file) {
  const storage::TemporaryDirectory folder;
  storage::write_bytes(folder / "model.ptree", file);
  const auto model = Model::open(folder / "model.ptree");
  if (!model) throw std::runtime_error(model.error().text);
  auto probe = Probe::create(*model);
  if (!probe) throw std::runtime_error(probe.error().text);
  std::mt19937_64 random(1);
  const auto coordinate = [&] { return static_cast<double>(random() >> 11) * 0x1p-46 - 64; };
  std::vector<ClosestPoint> answers;
  for (int i = 0; i < 300; ++i)
    answers.push_back(probe->closest_point({coordinate(), coordinate(), coordinate()}));
  return answers;
}

bool is_same(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

TEST(PageSizes, GiveTheSameAnswers) {
  const std::vector<ClosestPoint> expected = answer(sphere_with_pages(kPageSizes[0]));
  for (const std::uint32_t page_bytes : kPageSizes) {
    const std::vector<ClosestPoint> found = answer(sphere_with_pages(page_bytes));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_EQ(found[i].status, Status::kExact);
      EXPECT_EQ(found[i].triangle, expected[i].triangle) << page_bytes;
      EXPECT_EQ(found[i].distance, expected[i].distance) << page_bytes;
      EXPECT_EQ(found[i].lower, expected[i].lower) << page_bytes;
      EXPECT_EQ(found[i].upper, expected[i].upper) << page_bytes;
      EXPECT_EQ(found[i].feature, expected[i].feature) << page_bytes;
      EXPECT_TRUE(is_same(found[i].point, expected[i].point)) << page_bytes;
      EXPECT_TRUE(is_same(found[i].barycentric, expected[i].barycentric)) << page_bytes;
    }
  }
}

// Bounds in the order of the tree, independent of pages: a node with one child only is there
// because its block is alone in a page.
void collect_bounds(const SpecTree& tree, SpecLink link, std::vector<float>& bounds) {
  if (SpecTree::is_block(link)) return;
  const std::vector<SpecChild>& children = tree.node(link).children;
  if (children.size() == 1) return collect_bounds(tree, children.front().link, bounds);
  for (const SpecChild& child : children) {
    bounds.insert(bounds.end(), child.box.lower.begin(), child.box.lower.end());
    bounds.insert(bounds.end(), child.box.upper.begin(), child.box.upper.end());
    bounds.insert(bounds.end(), child.disc.normal.begin(), child.disc.normal.end());
    for (const float value : {child.disc.slab_lower, child.disc.slab_upper, child.disc.radius})
      bounds.push_back(value);
    collect_bounds(tree, child.link, bounds);
  }
}

TEST(PageSizes, GiveTheSameTree) {
  const SpecTree expected{SpecFile(sphere_with_pages(kPageSizes[0]))};
  std::vector<float> expected_bounds;
  collect_bounds(expected, expected.header().root_link(), expected_bounds);
  std::uint32_t pages_before = ~std::uint32_t{0};
  for (const std::uint32_t page_bytes : kPageSizes) {
    const SpecTree tree{SpecFile(sphere_with_pages(page_bytes))};
    std::vector<float> bounds;
    collect_bounds(tree, tree.header().root_link(), bounds);
    EXPECT_EQ(bounds, expected_bounds) << page_bytes;
    EXPECT_LE(tree.header().page_count, pages_before) << page_bytes;
    pages_before = tree.header().page_count;
    const auto ids = [](const SpecTree& of) {
      std::vector<std::uint64_t> found;
      for (const SpecTriangle& triangle : of.triangles(of.header().root_link()))
        found.push_back(triangle.id);
      return found;
    };
    EXPECT_EQ(ids(tree), ids(expected)) << page_bytes;
  }
  // The tree, the field and the mask.
  EXPECT_EQ(pages_before, 3u);
}

}  // namespace
}  // namespace planetree::golden
