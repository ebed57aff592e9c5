#include "query/file/tree_header.h"

#include <gtest/gtest.h>

#include <string>

// A file may have more pages than links in memory can tell apart. Such a header is refused.
namespace planetree::query {
namespace {

struct Pages {
  std::uint32_t surface = 0, caps = 0, field = 0, attributes = 0, mask = 0;
};

storage::FileHeader header_with(std::uint32_t page_bytes, const Pages& pages) {
  storage::FileHeader header{};
  header.page_bytes = page_bytes;
  header.page_count = pages.surface + pages.caps + pages.field + pages.attributes + pages.mask;
  header.model.block_count = 1;
  header.model.cap_page_count = pages.caps;
  header.model.field_page_count = pages.field;
  header.model.attribute_page_count = pages.attributes;
  header.model.mask_page_count = pages.mask;
  return header;
}

void expect_refused(std::uint32_t page_bytes, const Pages& pages, const std::string& count) {
  const auto checked = check_tree_header(header_with(page_bytes, pages));
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, ErrorCode::kUnsupported);
  const std::string text = checked.error().text;
  EXPECT_NE(text.find(count + " pages of " + std::to_string(page_bytes)), std::string::npos)
      << text;
  EXPECT_NE(text.find("pages of 262144 bytes"), std::string::npos) << text;
}

TEST(TreeHeader, AllowsAsManyPagesAsLinksCanTellApart) {
  EXPECT_TRUE(check_tree_header(header_with(4096, {.surface = (1U << 27) - 1})));
  EXPECT_TRUE(check_tree_header(header_with(65536, {.surface = 1U << 22, .caps = (1U << 22) - 1})));
  EXPECT_TRUE(check_tree_header(header_with(65536, {.surface = 1, .mask = 1U << 27})));
}

TEST(TreeHeader, RefusesMorePagesOfTreesAndOfTheMask) {
  expect_refused(4096, {.surface = 1U << 27}, "134217728");
  expect_refused(65536, {.surface = (1U << 23) - 1, .caps = 1}, "8388608");
  expect_refused(65536, {.surface = 1, .mask = (1U << 27) + 1}, "134217729");
}

// No link in a record leads to the pages of a field or of attributes.
TEST(TreeHeader, DoesNotCountOtherPages) {
  EXPECT_TRUE(check_tree_header(header_with(
      65536, {.surface = (1U << 23) - 1, .field = 9, .attributes = 1U << 30, .mask = 9})));
}

}  // namespace
}  // namespace planetree::query
