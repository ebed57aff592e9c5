// The pages that a page with few nodes leads to, as the directory tells them.

#include "query/file/pages_below.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "tests/query/chunked_sphere.h"

namespace planetree::query {
namespace {

using Bytes = std::vector<std::byte>;

// The linked pages of a distance page, by format-spec/v1/spec.md, 5.1 and 5.2.
std::vector<std::uint32_t> linked_pages(const Bytes& raw) {
  const auto head = [&raw](std::size_t at) {
    std::uint16_t value;
    std::memcpy(&value, raw.data() + at, sizeof value);
    return std::size_t{value};
  };
  const std::size_t nodes = head(16), roots = head(20), children = head(22), links = head(24);
  const std::byte* const stream = raw.data() + 40 + 24 * roots + 4 * nodes + 16 * children;
  std::vector<std::uint32_t> pages(links);
  for (std::size_t i = 0; i < links; ++i)
    for (std::size_t k = 0; k < 4; ++k)
      pages[i] |= std::to_integer<std::uint32_t>(stream[k * links + i]) << 8 * k;
  return pages;
}

class PagesBelow : public ChunkedSphere {
 protected:
  PagesBelow() : ChunkedSphere(6) {
    auto file = storage::PageFile::open(output_);
    if (!file) std::abort();
    file_.emplace(*std::move(file));
  }

  std::vector<std::uint32_t> found(std::uint32_t page, std::size_t room = 20) const {
    std::vector<std::uint32_t> pages(room);
    pages.resize(find_pages_below(*file_, page, pages));
    return pages;
  }
  std::vector<std::uint32_t> linked(std::uint32_t page) const {
    Bytes stored(file_->header().max_stored_bytes), raw(file_->entry(page)->raw_bytes);
    EXPECT_TRUE(file_->read_page(page, stored, raw));
    return linked_pages(raw);
  }

  std::optional<storage::PageFile> file_;
};

TEST_F(PagesBelow, AreMostOfThoseThatFewNodesLinkTo) {
  std::size_t pages = 0, links = 0, hits = 0;
  for (std::uint32_t page = 0; page < file_->header().first_cap_page(); ++page) {
    const std::vector<std::uint32_t> below = found(page), expected = linked(page);
    if (below.empty() || expected.empty()) continue;
    ++pages;
    links += expected.size();
    for (const std::uint32_t link : expected)
      hits += std::find(below.begin(), below.end(), link) != below.end();
  }
  EXPECT_GT(pages, 10u);
  EXPECT_GE(hits * 4, links * 3);
}

TEST_F(PagesBelow, AreNoneOfAPageWithMoreThanFewNodes) {
  std::size_t with_few = 0;
  for (std::uint32_t page = 0; page < file_->header().page_count; ++page) {
    const bool has_few = file_->entry(page)->raw_bytes <= 512;
    const bool is_distance_page = page < file_->header().first_cap_page();
    with_few += has_few && is_distance_page;
    EXPECT_TRUE((has_few && is_distance_page) || found(page).empty()) << page;
  }
  EXPECT_GT(with_few, 10u);
}

TEST_F(PagesBelow, AreOtherDistancePagesEachOnce) {
  for (std::uint32_t page = 0; page < file_->header().first_cap_page(); ++page) {
    std::vector<std::uint32_t> below = found(page);
    std::sort(below.begin(), below.end());
    EXPECT_EQ(std::adjacent_find(below.begin(), below.end()), below.end());
    EXPECT_FALSE(std::binary_search(below.begin(), below.end(), page));
    EXPECT_TRUE(below.empty() || below.back() < file_->header().first_cap_page());
  }
}

TEST_F(PagesBelow, AreAsManyAsThereIsRoomFor) {
  for (std::uint32_t page = 0; page < file_->header().first_cap_page(); ++page) {
    const std::vector<std::uint32_t> all = found(page), some = found(page, 2);
    EXPECT_LE(all.size(), 8u);
    ASSERT_EQ(some.size(), std::min<std::size_t>(all.size(), 2));
    EXPECT_TRUE(std::equal(some.begin(), some.end(), all.begin()));
    EXPECT_TRUE(found(page, 0).empty());
  }
}

}  // namespace
}  // namespace planetree::query
