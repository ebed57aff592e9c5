#include "octree/mask/mask_prefetcher.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "tests/octree/mask/random_mask.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {
namespace {

/// Resident pages of a mask. Records which of them were accessed.
class RecordedPages {
 public:
  explicit RecordedPages(PageReader pages) : pages_(pages) {}

  PageReader reader() {
    return {this,
            [](void*, std::uint32_t) noexcept -> const std::byte* {
              ADD_FAILURE() << "requested a page";
              return nullptr;
            },
            [](void* context, std::uint32_t number) noexcept {
              auto& self = *static_cast<RecordedPages*>(context);
              self.seen_.insert(number);
              return number == self.lost_ ? nullptr : self.pages_.peek(self.pages_.context, number);
            }};
  }
  void lose(std::uint32_t page) { lost_ = page; }
  std::set<std::uint32_t> take_accessed() { return std::exchange(seen_, {}); }

 private:
  const PageReader pages_;
  std::set<std::uint32_t> seen_;
  std::uint32_t lost_ = ~std::uint32_t{0};
};

class MaskPrefetcherTest : public testing::Test {
 protected:
  MaskPrefetcherTest() {
    TreeInfo tree;
    tree.box_lower = lower_;
    tree.box_upper = lower_ + Point(1.2, 1.9, 0.7);
    tree.core_lower = tree.box_lower;
    tree.core_upper = tree.box_upper;
    // The memory holds a grid of a level far above the leaves.
    side_grid_.fill(mask_, tree, CapGrid(), false, 0, pages_.resident_reader(), memory_);
  }
  std::vector<Point> points(std::size_t count) const {
    Noise noise(9);
    std::vector<Point> result;
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 p = noise.point(0, 1);
      result.push_back(lower_ + Point(1.2 * p.x, 1.9 * p.y, 0.7 * p.z));
    }
    return result;
  }
  // Runs all steps for `point` and returns their number.
  unsigned go(const Point& point, PageReader pages) const {
    MaskPrefetcher ahead(mask_, side_grid_, point);
    unsigned steps = 0;
    for (; ahead.goes_on(); ++steps) ahead.step(pages);
    return steps;
  }
  // The pages that look_up() accesses for `point`, by their number in the file.
  std::set<std::uint32_t> pages_of_search(const Point& point) {
    const SideGrid::Lookup lookup = side_grid_.look(point);
    if (lookup.winding != SideGrid::kUnknown || !lookup.record) return {};
    TraversalStats work;
    pages_.take_queried();
    look_up(mask_, lookup, point, ~std::uint64_t{0}, pages_.reader(), work);
    std::set<std::uint32_t> queried;
    for (const std::uint32_t page : pages_.take_queried()) queried.insert(kRandomMaskPage + page);
    return queried;
  }

  const Point lower_{-0.25, 3, 1.0 / 3};
  MaskPages pages_{random_mask(10), 4096, kRandomMaskPage};
  const MaskInfo mask_ = pages_.mask(lower_);
  alignas(16) std::array<std::byte, 6000> memory_{};
  SideGrid side_grid_;
};

TEST_F(MaskPrefetcherTest, PrefetchesThePagesOfTheLookup) {
  RecordedPages peeked(pages_.resident_reader());
  std::size_t searches = 0, several = 0;
  for (const Point& point : points(3000)) {
    const unsigned steps = go(point, peeked.reader());
    const std::set<std::uint32_t> seen = peeked.take_accessed(), queried = pages_of_search(point);
    EXPECT_LE(steps, kLevels + 2);
    if (queried.empty()) continue;
    ++searches;
    several += queried.size() > 1;
    ASSERT_EQ(seen, queried) << point.transpose();
    ASSERT_GE(steps, queried.size());
  }
  EXPECT_GT(searches, 300u);
  EXPECT_GT(several, 10u);
}

TEST_F(MaskPrefetcherTest, StopsAtPagesThatAreNotResident) {
  RecordedPages peeked(pages_.resident_reader());
  std::size_t stopped = 0;
  for (const Point& point : points(1000)) {
    const std::set<std::uint32_t> queried = pages_of_search(point);
    if (queried.empty()) continue;
    // Child pages come after their parents, so the least number is accessed first.
    peeked.lose(*queried.begin());
    go(point, peeked.reader());
    ASSERT_EQ(peeked.take_accessed(), (std::set<std::uint32_t>{*queried.begin()}));
    ++stopped;
  }
  EXPECT_GT(stopped, 100u);
}

TEST_F(MaskPrefetcherTest, DoesNothingWithoutASideGridRecord) {
  EXPECT_FALSE(MaskPrefetcher(mask_, SideGrid(), lower_ + Point::Constant(0.3)).goes_on());
  for (const double far : {10.0, 1e9, 1e300})
    EXPECT_FALSE(MaskPrefetcher(mask_, side_grid_, lower_ + Point::Constant(far)).goes_on()) << far;
  std::size_t known = 0;
  for (const Point& point : points(1000)) {
    if (side_grid_.lookup_of(point).record) continue;
    ++known;
    EXPECT_FALSE(MaskPrefetcher(mask_, side_grid_, point).goes_on());
  }
  EXPECT_GT(known, 100u);
}

// Frames of random bits, which no decoder would produce.
TEST_F(MaskPrefetcherTest, EndsOnRandomPages) {
  Noise noise(4);
  alignas(64) static std::array<std::uint64_t, 4096 / 8> frame;
  for (std::uint64_t& word : frame) word = std::uint64_t{noise.bits()} << 32 | noise.bits();
  const PageReader reader{nullptr, nullptr, [](void*, std::uint32_t) noexcept {
                            return reinterpret_cast<const std::byte*>(frame.data());
                          }};
  unsigned most = 0;
  for (const Point& point : points(3000)) most = std::max(most, go(point, reader));
  EXPECT_GT(most, 2u);
  EXPECT_LE(most, kLevels + 2);
}

}  // namespace
}  // namespace planetree::octree
