#include "octree/builder/mask/tree_frames.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>

#include "octree/builder/surface/region_cut.h"
#include "octree/page/page_decoder.h"
#include "tests/octree/builder/chunked_tree.h"
#include "tests/octree/support/height_field_model.h"
#include "tests/octree/support/sample_mask.h"
#include "tests/storage/system/faulty_calls.h"

namespace planetree::octree {
namespace {

constexpr std::uint32_t kLargePages = 262144;
constexpr std::uint32_t kHeld = TreeFrames::kBytes / kLargePages;

// A tree with more pages than TreeFrames keeps.
ChunkedTree many_pages(storage::SpillFile& file = spill_file()) {
  return ChunkedTree(sphere(4), 40, kLargePages, file);
}

const std::byte* page_of(TreeFrames& frames, std::uint32_t page) {
  return frames.reader().page(frames.reader().context, page);
}
bool holds(TreeFrames& frames, std::uint32_t page) {
  return frames.reader().peek(frames.reader().context, page) != nullptr;
}

void expect_page(const ChunkedTree& sample, TreeFrames& frames, std::uint32_t page) {
  const PageInfo info = sample.tree->info_of_page(page);
  SampleFrame expected(info.page_bytes);
  const auto raw = sample.tree->pages().encode(page);
  ASSERT_TRUE(raw);
  ASSERT_TRUE(decode_page(raw->bytes, info, expected.bytes()));
  const std::byte* frame = page_of(frames, page);
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(std::memcmp(frame, expected.data(), expected.header().used_bytes), 0) << page;
}

TEST(TreeFrames, MatchDecodedPages) {
  for (const std::uint32_t page_bytes : {4096u, kLargePages}) {
    const ChunkedTree sample(sphere(4), 40, page_bytes);
    TreeFrames frames(sample.tree.get());
    const std::uint32_t count = sample.tree->pages().size();
    ASSERT_GT(count, kHeld);
    for (std::uint32_t page = 0; page < count; ++page) expect_page(sample, frames, page);
    // Replaces frames, in random order.
    Noise noise(2);
    for (int i = 0; i < 100; ++i) expect_page(sample, frames, noise.bits() % count);
    EXPECT_TRUE(frames.state());
  }
}

TEST(TreeFrames, KeepTheMostRecentlyUsed) {
  const ChunkedTree sample = many_pages();
  TreeFrames frames(sample.tree.get());
  const std::uint32_t count = sample.tree->pages().size();
  ASSERT_GT(count, kHeld + 2);
  for (std::uint32_t page = 0; page < count; ++page) {
    const std::byte* frame = page_of(frames, page);
    EXPECT_EQ(page_of(frames, page), frame);
    // Page 0 is accessed after every other page.
    ASSERT_NE(page_of(frames, 0), nullptr);
  }
  EXPECT_TRUE(holds(frames, 0));
  EXPECT_TRUE(holds(frames, count - 1));
  EXPECT_TRUE(holds(frames, count + 1 - kHeld));
  EXPECT_FALSE(holds(frames, count - kHeld));
  EXPECT_FALSE(holds(frames, 1));
}

TEST(TreeFrames, KeepNoMorePagesThanFit) {
  const ChunkedTree sample = many_pages();
  TreeFrames frames(sample.tree.get());
  const std::uint32_t count = sample.tree->pages().size();
  for (std::uint32_t page = 0; page < count; ++page) ASSERT_NE(page_of(frames, page), nullptr);
  std::size_t held = 0;
  for (std::uint32_t page = 0; page < count; ++page) {
    EXPECT_EQ(holds(frames, page), page + kHeld >= count) << page;
    held += holds(frames, page);
  }
  EXPECT_EQ(held, kHeld);
}

TEST(TreeFrames, MatchDecodedMaskPages) {
  const HeightFieldModel model(sphere(5));
  const std::uint32_t first = model.mask_info.first_page;
  ASSERT_GT(model.mask.size(), 2u);
  TreeFrames frames(model.tree.tree.get(), &model.mask);
  for (std::uint32_t i = 0; i < model.mask.size(); ++i) {
    const auto raw = model.mask.encode(i, first);
    ASSERT_TRUE(raw);
    PageInfo info = model.tree.tree->info_of_page(0);
    info.first_page = info.tree_pages = first;
    info.page_count = model.mask.size();
    info.page_number = first + i;
    info.octcode = raw->octcode;
    SampleFrame expected(4096);
    ASSERT_TRUE(decode_mask_page(raw->bytes, info, expected.bytes()));
    const std::byte* frame = page_of(frames, first + i);
    ASSERT_NE(frame, nullptr);
    const std::size_t records_end = header_of(expected).first_plane_slot * kMaskSlotBytes;
    EXPECT_EQ(std::memcmp(frame, expected.data(), records_end), 0) << i;
    // Page numbers of the tree are the same with a mask.
    expect_page(model.tree, frames, i % first);
  }
  EXPECT_TRUE(frames.state());
}

class FramesAfterReadErrors : public testing::Test {
 protected:
  // All reads fail from now on.
  void lose_disk() {
    calls_.fault = storage::FaultyCalls::Fault::kError;
    calls_.number = EIO;
    calls_.fault_at = 0;
    calls_.every = true;
  }

  storage::FaultyCalls calls_;
  storage::SpillFile file_{std::filesystem::temp_directory_path(), 0, calls_};
};

TEST_F(FramesAfterReadErrors, KeepTheError) {
  const ChunkedTree sample = many_pages(file_);
  TreeFrames frames(sample.tree.get());
  const std::uint32_t last = sample.tree->pages().size() - 1;
  ASSERT_NE(page_of(frames, last), nullptr);
  lose_disk();
  EXPECT_NE(page_of(frames, last), nullptr);
  EXPECT_TRUE(frames.state());
  EXPECT_EQ(page_of(frames, last - 1), nullptr);
  ASSERT_FALSE(frames.state());
  EXPECT_EQ(frames.state().error().code, ErrorCode::kReadFailed);
  EXPECT_FALSE(holds(frames, last - 1));
  calls_.fault = storage::FaultyCalls::Fault::kNone;
  expect_page(sample, frames, last);
  for (std::uint32_t page = 0; page <= last; ++page) expect_page(sample, frames, page);
  EXPECT_FALSE(frames.state());
}

// A missing list would change the file.
TEST_F(FramesAfterReadErrors, FailTheMaskBuild) {
  const ChunkedTree sample(sphere(4), 40, 4096, file_);
  RegionCut cut(sample.mesh.frame, {}, nullptr);
  ASSERT_TRUE(cut.add(sample.mesh));
  MaskSectors sectors(sample.mesh.lower(), {}, cut.found().winding, false, 1 << 20, spill_file());
  ASSERT_TRUE(sectors.divide(*sample.runs, nullptr, false, 300) && sectors.add(sample.mesh));
  std::mutex mutex;
  std::size_t taken = 0;
  const auto build = [&] {
    taken = 0;
    return build_mask(
        sectors, *sample.runs, sample.tree.get(), [](std::size_t) { return nullptr; },
        [&](std::size_t, const MaskTree&, const SectorRoot&) -> Result<void> {
          const std::lock_guard lock(mutex);
          ++taken;
          return {};
        });
  };
  ASSERT_TRUE(build());
  EXPECT_EQ(taken, sectors.touched_count());
  lose_disk();
  const auto failed = build();
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, ErrorCode::kReadFailed);
  EXPECT_LT(taken, sectors.touched_count());
}

}  // namespace
}  // namespace planetree::octree
