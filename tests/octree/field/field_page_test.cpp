#include "octree/field/field_page.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "octree/builder/field/built_field.h"
#include "tests/octree/builder/field/sample_field.h"

namespace planetree::octree {
namespace {

constexpr std::uint32_t kFirstPage = 5;

class FieldPage : public testing::Test {
 protected:
  PageInfo info(std::uint32_t index) const {
    PageInfo info;
    info.page_bytes = sample_.page_bytes;
    info.first_page = kFirstPage;
    info.page_count = sample_.field.page_count();
    info.page_number = kFirstPage + index;
    return info;
  }
  std::size_t count(std::uint32_t index) const {
    const std::size_t in_page = points_per_field_page(sample_.page_bytes);
    return std::min(in_page, sample_.field.points().size() - index * in_page);
  }
  // The fault that the decoder names, or an empty text.
  std::string fault(const std::vector<std::byte>& raw, const PageInfo& info) const {
    std::vector<FieldPoint> points(count(info.page_number - kFirstPage));
    const auto decoded = decode_field_page(raw, info, points);
    return decoded ? "" : decoded.error().text;
  }

  SampleField sample_ = SampleField::of_sphere();
};

TEST_F(FieldPage, RestoresWhatWasEncoded) {
  ASSERT_GT(sample_.field.page_count(), 1u);
  std::vector<FieldPoint> all;
  for (std::uint32_t index = 0; index < sample_.field.page_count(); ++index) {
    const FilePage page = sample_.field.encode(index, kFirstPage);
    EXPECT_EQ(page.octcode, 0u);
    EXPECT_EQ(page.ordinal, index);
    std::vector<FieldPoint> points(count(index));
    ASSERT_TRUE(decode_field_page(page.bytes, info(index), points));
    all.insert(all.end(), points.begin(), points.end());
  }
  EXPECT_EQ(all, sample_.field.points());
}

TEST_F(FieldPage, RefusesPagesThatAreNotThoseOfTheTable) {
  const std::vector<std::byte> raw = sample_.field.encode(0, kFirstPage).bytes;
  EXPECT_EQ(fault(raw, info(0)), "");
  PageInfo other = info(0);
  other.page_number = kFirstPage + 1;
  EXPECT_NE(fault(raw, other).find("another page's bytes"), std::string::npos);
  other = info(0);
  other.octcode = 1;
  EXPECT_NE(fault(raw, other).find("octcode is not the directory's"), std::string::npos);
  other = info(0);
  other.first_page = kFirstPage - 1;
  EXPECT_NE(fault(raw, other).find("not that of its points"), std::string::npos);
}

TEST_F(FieldPage, RefusesWrongHeadsAndLengths) {
  const std::vector<std::byte> raw = sample_.field.encode(0, kFirstPage).bytes;
  const auto changed = [&](std::size_t offset) {
    std::vector<std::byte> bytes = raw;
    bytes[offset] ^= std::byte{1};
    return bytes;
  };
  EXPECT_NE(fault(changed(16), info(0)).find("as many points"), std::string::npos);
  EXPECT_NE(fault(changed(20), info(0)).find("reserved"), std::string::npos);
  std::vector<std::byte> cut(raw.begin(), raw.end() - 1);
  EXPECT_NE(fault(cut, info(0)).find("shorter"), std::string::npos);
  cut.resize(10);
  EXPECT_NE(fault(cut, info(0)).find("shorter than its head"), std::string::npos);
  std::vector<std::byte> longer = raw;
  longer.push_back(std::byte{0});
  EXPECT_NE(fault(longer, info(0)).find("longer"), std::string::npos);
}

TEST(FieldDifferences, AreFoldedAndUnfolded) {
  for (unsigned value = 0; value <= 0xffff; ++value) {
    const auto difference = static_cast<std::uint16_t>(value);
    EXPECT_EQ(unfold_difference(fold_difference(difference)), difference);
  }
  EXPECT_EQ(fold_difference(3), 6);
  EXPECT_EQ(fold_difference(0xffff), 1);
  EXPECT_EQ(fold_difference(0xfffe), 3);
}

}  // namespace
}  // namespace planetree::octree
