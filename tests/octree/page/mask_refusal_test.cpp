#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "octree/page/page_decoder.h"
#include "tests/octree/mask/random_mask.h"
#include "tests/octree/page/decoder_messages.h"
#include "tests/octree/page/mask_corruptions.h"
#include "tests/octree/support/sample_mask.h"

// Reaches every message with which a mask page is refused, by one change to a valid page each.
namespace planetree::octree {
namespace {

class MaskRefusal : public testing::TestWithParam<bool> {
 protected:
  MaskRefusal() : pages_(random_mask(10), 4096, kRandomMaskPage, GetParam()) {}

  // Returns a page other than the mask's first that has pages below it and leaves of all kinds.
  std::uint32_t sample() const {
    for (std::uint32_t page = 1; page < pages_.size(); ++page) {
      const RawMaskPage raw = RawMaskPage::of(pages_.raw(page), GetParam());
      const auto has = [&](MaskKind kind) {
        return std::ranges::count(raw.kinds, static_cast<std::uint8_t>(kind)) > 0;
      };
      if (raw.head.page_link_count > 1 && has(MaskKind::kPlainCorners) && has(MaskKind::kCorners) &&
          has(MaskKind::kSpecial) && has(MaskKind::kListed) && has_long_lists(raw) &&
          raw.kinds.back() > static_cast<std::uint8_t>(MaskKind::kNodeWithLink))
        return page;
    }
    ADD_FAILURE() << "no page of the sample suits";
    return 0;
  }

  // Whether lists of the maximum length would exceed the page.
  static bool has_long_lists(const RawMaskPage& page) {
    std::size_t slots = mask_head_slots(4096) + page.head.record_count + page.planes.size();
    slots += page.block_counts.size() * list_slots(kMaxListed);
    return slots * kMaskSlotBytes > 4096;
  }

  MaskPages pages_;
};

INSTANTIATE_TEST_SUITE_P(Planes, MaskRefusal, testing::Bool());

TEST_P(MaskRefusal, ReportsFaultAndPage) {
  const std::uint32_t page = sample();
  for (const MaskCorruption& corruption : all_mask_corruptions()) {
    SCOPED_TRACE(corruption.sentence);
    PageInfo info = pages_.info(page);
    RawMaskPage raw = RawMaskPage::of(pages_.raw(page), GetParam());
    SampleFrame frame(info.page_bytes);
    ASSERT_TRUE(decode_mask_page(raw.bytes(), info, frame.bytes()));
    corruption.corrupt(raw, info);
    frame = SampleFrame(info.page_bytes);
    const auto decoded = decode_mask_page(raw.bytes(), info, frame.bytes());
    ASSERT_FALSE(decoded);
    EXPECT_EQ(decoded.error().code, ErrorCode::kDamaged);
    EXPECT_EQ(decoded.error().page, info.page_number);
    EXPECT_EQ(std::string(decoded.error().text), "mask page " + std::to_string(info.page_number) +
                                                     " is damaged: " + corruption.sentence +
                                                     "; build the file again");
  }
}

TEST(MaskRefusalTexts, CoverEveryMessageOfTheDecoder) {
  std::set<std::string> reached;
  for (const MaskCorruption& corruption : all_mask_corruptions())
    reached.insert(corruption.sentence);
  expect_every_message(reached, {"mask_streams", "mask_decoder"});
}

}  // namespace
}  // namespace planetree::octree
