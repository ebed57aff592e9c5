#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "octree/page/page_streams.h"
#include "tests/tools/check/mask_check_fixture.h"

// Issues that verify finds in the height-field bits of blocks.
namespace planetree::tools {
namespace {

class FileCheckOfHeightFields : public FileCheckOfMasks {
 protected:
  using Counts = std::function<std::uint8_t(std::uint8_t count)>;

  // Forges the triangle counts of all blocks.
  Forgery forgery_of(const Counts& changed) {
    Forgery forgery;
    forgery.page = [changed](std::uint32_t, RawPage& page) {
      for (std::size_t i = 0; i < page.elements("triangle_counts"); ++i)
        page.set("triangle_counts", i, changed(page.get<std::uint8_t>("triangle_counts", i)));
    };
    return forgery;
  }
  CheckReport check_counts(const std::filesystem::path& tree, const Counts& changed, bool full) {
    return check_forgery(tree, forgery_of(changed), full);
  }

  // Sets the bit of block number `which` among the blocks without it.
  Counts marking(std::size_t which) {
    return [left = which](std::uint8_t count) mutable -> std::uint8_t {
      const bool clear = (count & octree::kHeightFieldBit) == 0;
      return clear && left-- == 0 ? count | octree::kHeightFieldBit : count;
    };
  }
  std::size_t count_unmarked(const std::filesystem::path& tree) {
    std::size_t unmarked = 0;
    check_counts(
        tree,
        [&](std::uint8_t count) {
          unmarked += (count & octree::kHeightFieldBit) == 0;
          return count;
        },
        false);
    return unmarked;
  }
};

TEST_F(FileCheckOfHeightFields, FindsEveryBlockWronglyMarked) {
  const std::size_t unmarked = count_unmarked(boxes());
  ASSERT_GT(unmarked, 2u);
  for (std::size_t i = 0; i < unmarked; ++i) {
    const CheckReport report = check_counts(boxes(), marking(i), true);
    EXPECT_EQ(codes_of(report), Codes{"BLOCK_HEIGHT_FIELD"}) << i;
    EXPECT_EQ(report.issues.count(), 1u);
    EXPECT_EQ(codes_of(check_counts(boxes(), marking(i), false)), Codes{});
  }
}

TEST_F(FileCheckOfHeightFields, AllowsUnmarkedHeightFields) {
  const auto clear = [](std::uint8_t count) {
    return static_cast<std::uint8_t>(count & ~octree::kHeightFieldBit);
  };
  for (const auto& tree : {boxes(), sphere()})
    EXPECT_EQ(codes_of(check_counts(tree, clear, true)), Codes{});
}

// Even blocks that are height fields of the whole mesh are found in the file of a region.
TEST_F(FileCheckOfHeightFields, FindsWronglyMarkedBlocksInFilesOfRegions) {
  const std::filesystem::path region = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/region.ptree";
  const std::size_t unmarked = count_unmarked(region);
  ASSERT_GT(unmarked, 2u);
  EXPECT_EQ(codes_of(check_path(region, true)), Codes{});
  for (std::size_t i = 0; i < unmarked; ++i)
    EXPECT_EQ(codes_of(check_counts(region, marking(i), true)), Codes{"BLOCK_HEIGHT_FIELD"});
}

// The bits are proven by the mask.
TEST_F(FileCheckOfHeightFields, AreNotCheckedWhereTheMaskIsWrong) {
  Forgery forgery = forgery_of(marking(0));
  forgery.mask = [done = false](std::uint32_t, RawMaskPage& page) mutable {
    if (done || page.head.corners_count == 0) return;
    done = true;
    page.corners[3] = static_cast<std::int8_t>(page.corners[3] + 1);
  };
  EXPECT_EQ(codes_of(check_forgery(boxes(), forgery, true)), Codes{"MASK_CORNER"});
}

}  // namespace
}  // namespace planetree::tools
