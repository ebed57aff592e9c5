#include "octree/builder/mask/height_field_marks.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cerrno>
#include <filesystem>
#include <vector>

#include "octree/page/page_streams.h"
#include "tests/octree/support/height_field_model.h"
#include "tests/storage/system/faulty_calls.h"

namespace planetree::octree {
namespace {

std::vector<bool> marks_in(const HeightFieldModel& model, const FilePage& page) {
  RawStreams streams;
  std::vector<bool> marks;
  EXPECT_EQ(streams.read(page.bytes, model.info.shape), nullptr);
  for (std::size_t i = 0; i < streams.head.block_count; ++i)
    marks.push_back(streams.is_height_field(i));
  return marks;
}

std::vector<FilePage> pages_of(const HeightFieldModel& model) {
  std::vector<FilePage> pages;
  for (std::uint32_t number = 0; number < model.tree.tree->pages().size(); ++number)
    pages.push_back(*model.tree.tree->pages().encode(number));
  return pages;
}

// The page with all marks cleared. All other bytes stay.
FilePage unmarked(FilePage page, std::size_t blocks) {
  for (std::size_t i = 0; i < blocks; ++i)
    page.bytes[page.blocks_at + i] &= ~std::byte{kHeightFieldBit};
  return page;
}

TEST(HeightFieldMarks, MatchTheBlocksFound) {
  const HeightFieldModel model(joined({sphere(4), translated(sphere(4), {0.9, 0, 0})}));
  std::vector<std::vector<bool>> found(model.tree.tree->pages().size());
  TreeFrames frames(model.tree.tree.get(), &model.mask);
  const HeightFieldFinder finder(model.info, model.mask_info);
  TraversalStats work;
  std::size_t height_fields = 0, in_none = 0;
  model.each_block([&](const BlockView& block, std::uint32_t page) {
    found[page].push_back(finder.is_height_field(block, frames.reader(), work));
    ++(found[page].back() ? height_fields : in_none);
  });
  ASSERT_GT(height_fields, 0u);
  ASSERT_GT(in_none, 0u);
  HeightFieldMarks marks(model.tree.tree.get(), model.mask);
  const std::vector<FilePage> before = pages_of(model);
  for (std::uint32_t number = 0; number < before.size(); ++number) {
    FilePage page = before[number];
    ASSERT_TRUE(marks.mark(number, page));
    EXPECT_EQ(marks_in(model, page), found[number]) << number;
    EXPECT_EQ(unmarked(page, found[number].size()).bytes, before[number].bytes);
  }
}

TEST(HeightFieldMarks, DoNotDependOnThreads) {
  const HeightFieldModel model(sphere(5));
  std::vector<FilePage> one = pages_of(model), many = one;
  HeightFieldMarks marks(model.tree.tree.get(), model.mask),
      others(model.tree.tree.get(), model.mask);
  for (std::uint32_t number = 0; number < one.size(); ++number)
    ASSERT_TRUE(marks.mark(number, one[number]));
  tbb::parallel_for(std::size_t{0}, many.size(), [&](std::size_t number) {
    EXPECT_TRUE(others.mark(static_cast<std::uint32_t>(number), many[number]));
  });
  for (std::size_t number = 0; number < one.size(); ++number)
    EXPECT_EQ(one[number].bytes, many[number].bytes);
}

// A missing mark would change the file, so any failing read is an error: of the page itself or
// during the walk around a block.
TEST(HeightFieldMarks, FailOnReadErrors) {
  storage::FaultyCalls calls;
  storage::SpillFile file(std::filesystem::temp_directory_path(), 0, calls);
  const HeightFieldModel model(sphere(5), file);
  std::vector<FilePage> pages = pages_of(model);
  const std::uint32_t last = static_cast<std::uint32_t>(pages.size()) - 1;
  std::size_t failures = 0;
  for (bool failed = true; failed; failures += failed) {
    calls = storage::FaultyCalls();
    calls.fault = storage::FaultyCalls::Fault::kError;
    calls.fault_at = static_cast<int>(failures);
    HeightFieldMarks marks(model.tree.tree.get(), model.mask);
    const auto marked = marks.mark(last, pages[last]);
    failed = !marked;
    EXPECT_TRUE(marked || marked.error().code == ErrorCode::kReadFailed);
  }
  EXPECT_GT(failures, 3u);
}

}  // namespace
}  // namespace planetree::octree
