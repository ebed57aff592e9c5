#include "octree/attributes/attribute_page.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "octree/page/frame.h"

namespace planetree::octree {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::uint32_t kPage = 9, kTreePages = 4, kPageBytes = 4096, kCount = 5;

// Element i of n has its byte k at k n + i.
template <class T>
void append_split(Bytes& raw, const std::vector<T>& elements) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(elements.data());
  for (std::size_t k = 0; k < sizeof(T); ++k)
    for (std::size_t i = 0; i < elements.size(); ++i) raw.push_back(bytes[i * sizeof(T) + k]);
}

StoredLink link_of(std::uint32_t i) {
  if (i == 3) return kNoStoredLink;
  return {i % kTreePages, static_cast<std::uint16_t>(i)};
}
std::array<Color, 3> colors_of(std::uint32_t i) {
  const auto byte = [i](std::uint32_t k) { return static_cast<std::uint8_t>(12 * i + k); };
  std::array<Color, 3> colors;
  for (std::uint32_t k = 0; k < 3; ++k)
    colors[k] = {byte(4 * k), byte(4 * k + 1), byte(4 * k + 2), byte(4 * k + 3)};
  return colors;
}
float uv_of(std::uint32_t i, std::uint32_t k) { return static_cast<float>(6 * i + k) / 7; }
std::uint64_t value_of(std::uint32_t i) { return ~std::uint64_t{0} / (i + 1); }

// A page composed after the specification.
Bytes page_of(AttributeShape shape) {
  Bytes raw(sizeof(AttributePageHead));
  const AttributePageHead head{kPage, 1, 0, kCount, 0};
  std::memcpy(raw.data(), &head, sizeof head);
  std::vector<std::uint32_t> pages;
  std::vector<std::uint16_t> blocks;
  std::vector<std::array<Color, 3>> colors;
  std::vector<float> uvs;
  std::vector<std::uint64_t> values;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    pages.push_back(link_of(i).page);
    blocks.push_back(link_of(i).record);
    colors.push_back(colors_of(i));
    for (std::uint32_t k = 0; k < 6; ++k) uvs.push_back(uv_of(i, k));
    values.push_back(value_of(i));
  }
  append_split(raw, pages);
  append_split(raw, blocks);
  if (shape.has_colors()) append_split(raw, colors);
  if (shape.has_uvs()) append_split(raw, uvs);
  if (shape.has_values()) append_split(raw, values);
  return raw;
}

PageInfo info() {
  PageInfo info;
  info.page_bytes = kPageBytes;
  info.first_page = kPage - 1;
  info.page_count = 2;
  info.tree_pages = kTreePages;
  info.page_number = kPage;
  return info;
}

// The fault that the decoder names, or an empty text.
std::string fault(const Bytes& raw, const PageInfo& info, AttributeShape shape = {kAllAttributes}) {
  std::vector<std::byte> frame(kPageBytes);
  const auto decoded = decode_attribute_page(raw, info, shape, kCount, frame);
  return decoded ? "" : decoded.error().text;
}

TEST(AttributePage, RestoresWhatWasStored) {
  for (std::uint32_t kinds = 0; kinds < 8; ++kinds) {
    const AttributeShape shape{kKeepTriangles | kinds << 1};
    std::vector<std::byte> frame(kPageBytes);
    ASSERT_TRUE(decode_attribute_page(page_of(shape), info(), shape, kCount, frame));
    const AttributeView view(frame.data(), shape);
    ASSERT_EQ(view.count(), kCount);
    for (std::uint32_t i = 0; i < kCount; ++i) {
      EXPECT_EQ(view.link(i),
                i == 3 ? kNoLink : LinkFormat::numbered(kPageBytes).make_block(link_of(i)));
      if (shape.has_colors()) {
        EXPECT_EQ(view.colors(i), colors_of(i));
      }
      if (shape.has_uvs()) {
        for (std::uint32_t k = 0; k < 3; ++k)
          EXPECT_EQ(view.uvs(i)[k], (TextureCoordinate{uv_of(i, 2 * k), uv_of(i, 2 * k + 1)}));
      }
      if (shape.has_values()) {
        EXPECT_EQ(view.value(i), value_of(i));
      }
    }
  }
}

TEST(AttributePage, HasAsManyTrianglesAsFit) {
  EXPECT_EQ(AttributeShape{kKeepTriangles}.triangles_per_page(4096), 1008u);
  EXPECT_EQ(AttributeShape{kAllAttributes}.triangles_per_page(4096), 84u);
  EXPECT_EQ(AttributeShape{kAllAttributes}.triangles_per_page(262144), 5460u);
  for (std::uint32_t kinds = 0; kinds < 8; ++kinds) {
    const AttributeShape shape{kKeepTriangles | kinds << 1};
    const std::size_t count = shape.triangles_per_page(4096);
    const std::size_t end = AttributeView::colors_at(shape, count) +
                            (shape.has_colors() ? count * AttributeShape::kColorBytes : 0);
    EXPECT_LE(end, 4096u);
    EXPECT_EQ(end, AttributeShape::kHeadBytes + count * shape.triangle_bytes());
  }
}

TEST(AttributePage, RefusesPagesThatAreNotThoseOfTheTable) {
  const Bytes raw = page_of({kAllAttributes});
  EXPECT_EQ(fault(raw, info()), "");
  PageInfo other = info();
  other.page_number = kPage + 1;
  EXPECT_NE(fault(raw, other).find("another page's bytes"), std::string::npos);
  other = info();
  other.octcode = 1;
  EXPECT_NE(fault(raw, other).find("octcode is not the directory's"), std::string::npos);
  other = info();
  other.first_page = kPage;
  EXPECT_NE(fault(raw, other).find("not that of its triangles"), std::string::npos);
}

TEST(AttributePage, RefusesWrongHeadsAndLengths) {
  const Bytes raw = page_of({kAllAttributes});
  const auto changed = [&raw](std::size_t offset) {
    Bytes bytes = raw;
    bytes[offset] ^= std::byte{1};
    return bytes;
  };
  EXPECT_NE(fault(changed(16), info()).find("as many triangles"), std::string::npos);
  EXPECT_NE(fault(changed(20), info()).find("reserved"), std::string::npos);
  for (const std::size_t size : {std::size_t{0}, std::size_t{23}, raw.size() - 1}) {
    const Bytes cut(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_NE(fault(cut, info()).find("shorter"), std::string::npos) << size;
  }
  Bytes longer = raw;
  longer.push_back({});
  EXPECT_NE(fault(longer, info()).find("longer"), std::string::npos);
  EXPECT_NE(fault(raw, info(), {kKeepTriangles}).find("longer"), std::string::npos);
}

TEST(AttributePage, RefusesLinksThatLeadToNoBlockByTheirForm) {
  constexpr auto kBlocks = static_cast<std::uint16_t>(max_page_blocks(kPageBytes));
  for (const StoredLink link : {StoredLink{kTreePages, 0}, StoredLink{1, kBlocks},
                                StoredLink{kNoStoredLink.page, 0}, StoredLink{0, 0xffff}}) {
    Bytes raw = page_of({kAllAttributes});
    std::byte* const pages = raw.data() + sizeof(AttributePageHead) + 2;
    for (std::size_t k = 0; k < sizeof link.page; ++k)
      pages[k * kCount] = static_cast<std::byte>(link.page >> (8 * k));
    for (std::size_t k = 0; k < sizeof link.record; ++k)
      pages[(sizeof link.page + k) * kCount] = static_cast<std::byte>(link.record >> (8 * k));
    EXPECT_NE(fault(raw, info()).find("does not lead to a block"), std::string::npos)
        << link.page << ' ' << link.record;
  }
}

}  // namespace
}  // namespace planetree::octree
