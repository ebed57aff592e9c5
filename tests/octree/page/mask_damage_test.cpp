#include <gtest/gtest.h>

#include <algorithm>

#include "octree/mask/mask_lookup.h"
#include "octree/page/mask_streams.h"
#include "octree/page/page_decoder.h"
#include "tests/octree/mask/random_mask.h"
#include "tests/octree/support/sample_mask.h"

// Mask pages with arbitrary bits are refused or harmless.
namespace planetree::octree {
namespace {

class MaskDamage : public testing::TestWithParam<bool> {
 protected:
  MaskDamage() : pages_(random_mask(10), 4096, kRandomMaskPage, GetParam()) {}

  // Checks the list as its readers rely on it.
  static void expect_list(const MaskLookup& found) {
    const MaskBlocks& blocks = found.blocks;
    ASSERT_LE(blocks.count, kMaxListed);
    for (unsigned i = 0; i < blocks.count; ++i) {
      EXPECT_NE(blocks.octants[i], 0);
      EXPECT_TRUE(LinkFormat::is_leaf(blocks.links[i]));
      EXPECT_LT(LinkFormat::numbered(4096).page(blocks.links[i]), kRandomMaskPage);
      EXPECT_LT(LinkFormat::numbered(4096).record(blocks.links[i]), max_page_blocks(4096));
      EXPECT_TRUE(i == 0 || blocks.links[i - 1] < blocks.links[i]);
    }
    EXPECT_NE(found.corners[0], kListedTag);
  }

  MaskPages pages_;
};

INSTANTIATE_TEST_SUITE_P(Planes, MaskDamage, testing::Bool());

TEST_P(MaskDamage, RefusesTruncatedPages) {
  const std::uint32_t page = 1;
  const std::vector<std::byte>& raw = pages_.raw(page);
  SampleFrame frame(4096);
  for (std::size_t length = 0; length < raw.size(); ++length) {
    // A copy of exactly `length` bytes, so that a sanitizer reports a read beyond.
    const std::vector<std::byte> cut(raw.begin(),
                                     raw.begin() + static_cast<std::ptrdiff_t>(length));
    ASSERT_FALSE(decode_mask_page(cut, pages_.info(page), frame.bytes())) << length;
  }
}

TEST_P(MaskDamage, RefusesRandomBytes) {
  const std::uint32_t page = 1;
  Noise noise(6);
  SampleFrame frame(4096);
  for (int i = 0; i < 500; ++i) {
    std::vector<std::byte> raw(noise.bits() % 3000);
    for (std::byte& byte : raw) byte = static_cast<std::byte>(noise.bits());
    EXPECT_FALSE(decode_mask_page(raw, pages_.info(page), frame.bytes()));
    // A valid head before the noise.
    if (raw.size() < sizeof(MaskPageHead)) continue;
    std::copy_n(pages_.raw(page).begin(), sizeof(MaskPageHead), raw.begin());
    raw.resize(pages_.raw(page).size());
    EXPECT_FALSE(decode_mask_page(raw, pages_.info(page), frame.bytes()));
  }
}

// Compares up to the end of the page's records. Nothing behind that is written.
TEST_P(MaskDamage, IgnoresOldFrameContents) {
  for (std::uint32_t page = 0; page < pages_.size(); ++page) {
    SampleFrame zeros(4096), ones(4096);
    std::ranges::fill(zeros.bytes(), std::byte{0});
    std::ranges::fill(ones.bytes(), std::byte{0xff});
    ASSERT_TRUE(decode_mask_page(pages_.raw(page), pages_.info(page), zeros.bytes()));
    ASSERT_TRUE(decode_mask_page(pages_.raw(page), pages_.info(page), ones.bytes()));
    const auto [end, same_end] = std::ranges::mismatch(zeros.bytes(), ones.bytes());
    EXPECT_GT(end - zeros.bytes().begin(), 0);
    EXPECT_TRUE(
        std::all_of(end, zeros.bytes().end(), [](std::byte b) { return b == std::byte{0}; }));
    EXPECT_TRUE(std::all_of(same_end, ones.bytes().end(),
                            [](std::byte b) { return b == std::byte{0xff}; }));
  }
}

// Flips random bits: the page is refused, or lookups in it stay within their bounds.
TEST_P(MaskDamage, SurvivesFlippedBits) {
  Noise noise(7);
  int refused = 0, taken = 0;
  for (int i = 0; i < 1500; ++i) {
    const std::uint32_t page = i % 2 == 0 ? 0 : 1;
    std::vector<std::byte> raw = pages_.raw(page);
    for (unsigned k = 0; k <= noise.bits() % 3; ++k)
      raw[noise.bits() % raw.size()] ^= std::byte{1} << noise.bits() % 8;
    SampleFrame frame(4096);
    if (!decode_mask_page(raw, pages_.info(page), frame.bytes())) {
      ++refused;
      continue;
    }
    ++taken;
    struct Changed {
      PageReader others;
      std::uint32_t number;
      const std::byte* frame;
    } changed{pages_.reader(), kRandomMaskPage + page, frame.data()};
    const PageReader reader{
        &changed, [](void* context, std::uint32_t number) noexcept -> const std::byte* {
          const auto& pages = *static_cast<Changed*>(context);
          return number == pages.number ? pages.frame
                                        : pages.others.page(pages.others.context, number);
        }};
    for (int k = 0; k < 20; ++k) {
      const Vec3 p = noise.point(0, 2);
      TraversalStats work;
      const MaskLookup found =
          look_up(pages_.mask(Point::Zero()), {p.x, p.y, p.z}, 100, reader, work);
      EXPECT_LE(work.nodes, kLevels);
      expect_list(found);
    }
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(taken, 100);
}

}  // namespace
}  // namespace planetree::octree
