// The independent reader decodes attribute pages that are composed here by "Attribute page", and
// refuses a page that breaks one of its rules.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "tests/golden/attributes/spec_attributes.h"

namespace planetree::golden {
namespace {

constexpr std::uint32_t kLinkBit = 1, kColourBit = 2, kUvBit = 4, kValueBit = 8, kAllBits = 15;

// A file with 3 distance pages, a cap page, a field page, attribute pages from page 5 on, and a
// mask page. It has 100 indices and pages of 4096 bytes, so that an attribute page with all
// attributes has up to 4032 / 48 = 84 triangles.
SpecHeader composed_header(std::uint32_t attributes, std::uint32_t attribute_pages) {
  SpecHeader header{};
  header.page_bytes = 4096;
  header.triangle_count = 98;
  header.skipped_count = 2;
  header.cap_pages = header.field_pages = header.mask_pages = 1;
  header.attribute_pages = attribute_pages;
  header.page_count = 6 + attribute_pages;
  header.attributes = attributes;
  return header;
}

template <class T>
void append_split(std::vector<std::byte>& raw, const std::vector<T>& elements) {
  const auto bytes = std::as_bytes(std::span(elements));
  for (std::size_t k = 0; k < sizeof(T); ++k)
    for (std::size_t i = 0; i < elements.size(); ++i) raw.push_back(bytes[i * sizeof(T) + k]);
}

// A page in parts. Of each triangle i, by its place in the page, all attributes differ from those
// of the others.
struct ComposedPage {
  ComposedPage(std::uint32_t number, std::uint32_t rank, std::uint32_t triangles)
      : head{number, rank, 0, 0, triangles, 0} {
    for (std::uint32_t i = 0; i < triangles; ++i) {
      links.push_back(spec_link(true, i % 3, i % 16));
      std::array<std::uint8_t, 12>& colour = colours.emplace_back();
      for (std::uint32_t k = 0; k < 12; ++k) colour[k] = static_cast<std::uint8_t>(12 * i + k);
      for (std::uint32_t k = 0; k < 6; ++k)
        uvs.push_back(static_cast<float>(i) - 0.125f * static_cast<float>(k));
      values.push_back(0x0102030405060708 * (i + 1));
    }
  }

  std::vector<std::byte> raw(std::uint32_t attributes) const {
    std::vector<std::byte> raw;
    for (const std::uint32_t word : head)
      for (unsigned k = 0; k < 4; ++k) raw.push_back(static_cast<std::byte>(word >> (8 * k)));
    if ((attributes & kLinkBit) != 0) append_links(raw);
    if ((attributes & kColourBit) != 0) append_split(raw, colours);
    if ((attributes & kUvBit) != 0) append_split(raw, uvs);
    if ((attributes & kValueBit) != 0) append_split(raw, values);
    raw.insert(raw.end(), tail, std::byte{0});
    if (is_short) raw.pop_back();
    return raw;
  }

  void append_links(std::vector<std::byte>& raw) const {
    std::vector<std::uint32_t> pages;
    std::vector<std::uint16_t> blocks;
    for (const SpecLink link : links) {
      pages.push_back(page_of_link(link));
      blocks.push_back(static_cast<std::uint16_t>(link));
    }
    append_split(raw, pages);
    append_split(raw, blocks);
  }

  // ComposedPage number, ordinal, both halves of the octcode, triangle count and reserved.
  std::array<std::uint32_t, 6> head;
  std::vector<SpecLink> links;
  std::vector<std::array<std::uint8_t, 12>> colours;
  std::vector<float> uvs;
  std::vector<std::uint64_t> values;
  std::size_t tail = 0;
  bool is_short = false;
};

void expect_attributes(const SpecAttributeLists& found, const ComposedPage& page,
                       std::uint32_t attributes) {
  const std::size_t count = page.links.size();
  EXPECT_EQ(found.links, page.links);
  ASSERT_EQ(found.colours.size(), (attributes & kColourBit) != 0 ? count : 0);
  ASSERT_EQ(found.uvs.size(), (attributes & kUvBit) != 0 ? count : 0);
  EXPECT_EQ(found.values, (attributes & kValueBit) != 0 ? page.values : decltype(page.values)());
  for (std::size_t i = 0; i < found.colours.size(); ++i)
    for (std::size_t k = 0; k < 12; ++k)
      EXPECT_EQ(found.colours[i][k / 4][k % 4], page.colours[i][k]) << i << ' ' << k;
  for (std::size_t i = 0; i < found.uvs.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_EQ(found.uvs[i][k / 2][k % 2], page.uvs[6 * i + k]) << i << ' ' << k;
}

TEST(SpecAttributePage, HoldsTheAttributesOfItsTriangles) {
  const SpecHeader header = composed_header(kAllBits, 2);
  ASSERT_EQ(header.a(), 5u);
  for (const ComposedPage& page : {ComposedPage(5, 0, 84), ComposedPage(6, 1, 16)})
    expect_attributes(decode_attribute_page(page.raw(kAllBits), page.head[0], header), page,
                      kAllBits);
}

TEST(SpecAttributePage, HasTheStreamsOfTheFilesAttributes) {
  const ComposedPage page(5, 0, 100);
  for (const std::uint32_t attributes : {kLinkBit, kLinkBit | kColourBit, kLinkBit | kUvBit,
                                         kLinkBit | kValueBit, kLinkBit | kUvBit | kValueBit}) {
    const SpecHeader header = composed_header(attributes, 1);
    expect_attributes(decode_attribute_page(page.raw(attributes), 5, header), page, attributes);
    EXPECT_THROW(decode_attribute_page(page.raw(attributes ^ kColourBit), 5, header),
                 std::runtime_error);
  }
}

// Two triangles with a link and colours, byte by byte.
TEST(SpecAttributePage, IsSplitIntoBytes) {
  SpecHeader header = composed_header(kLinkBit | kColourBit, 1);
  header.triangle_count = 1;
  header.skipped_count = 1;
  const unsigned char bytes[] = {5,    0,    0,    0,    0,    0,    0,    0,    0,
                                 0,    0,    0,    0,    0,    0,    0,  // page 5, rank 0, octcode
                                 2,    0,    0,    0,    0,    0,    0,    0,     // 2 triangles
                                 0xff, 0x02, 0xff, 0x00, 0xff, 0x00, 0xff, 0x00,  // pages
                                 0xff, 0x05, 0xff, 0x00,                          // blocks
                                 0,    10,   0,    20,   0,    30,   0,    255,  0,
                                 40,   0,    50,   0,    60,   0,    254,         // corners 0 and 1
                                 0,    70,   0,    80,   0,    90,   0,    253};  // corner 2
  const SpecAttributeLists found =
      decode_attribute_page(std::as_bytes(std::span(bytes)), 5, header);
  EXPECT_EQ(found.links, (std::vector<SpecLink>{kNoBlock, spec_link(true, 2, 5)}));
  EXPECT_EQ(found.colours, (std::vector<SpecColours>{
                               {}, {{{10, 20, 30, 255}, {40, 50, 60, 254}, {70, 80, 90, 253}}}}));
}

TEST(SpecAttributePage, MayHaveAnyUvsAndValues) {
  const SpecHeader header = composed_header(kAllBits, 2);
  ComposedPage page(6, 1, 16);
  page.uvs[0] = std::numeric_limits<float>::quiet_NaN();
  page.uvs[1] = -std::numeric_limits<float>::infinity();
  page.uvs[2] = -0.0f;
  page.values[0] = ~std::uint64_t{0};
  const SpecAttributeLists found = decode_attribute_page(page.raw(kAllBits), 6, header);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(found.uvs[0][k / 2][k % 2]),
              std::bit_cast<std::uint32_t>(page.uvs[k]));
  EXPECT_EQ(found.values[0], page.values[0]);
}

// The text with which a page is refused, or nothing.
std::string refusal_of_page(const std::function<void(ComposedPage&)>& change) {
  ComposedPage page(6, 1, 16);
  change(page);
  try {
    decode_attribute_page(page.raw(kAllBits), 6, composed_header(kAllBits, 2));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

std::string refusal_of_link(SpecLink link) {
  return refusal_of_page([link](ComposedPage& page) { page.links[7] = link; });
}

TEST(SpecAttributePage, IsRefusedIfItsHeadIsWrong) {
  EXPECT_EQ(refusal_of_page([](ComposedPage&) {}), "");
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page.head[0] = 5; }), "another page");
  const std::string key = "key of an attribute page";
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page.head[1] = 0; }), key);
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page.head[2] = 1; }), key);
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page.head[3] = 0x08000000; }), key);
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page.head[5] = 1; }),
            "reserved bytes of an attribute page");
}

TEST(SpecAttributePage, IsRefusedIfItHasMoreOrFewerTriangles) {
  const std::string count = "triangles of an attribute page";
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page = ComposedPage(6, 1, 15); }), count);
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page = ComposedPage(6, 1, 17); }), count);
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page = ComposedPage(6, 1, 84); }), count);
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page = ComposedPage(6, 1, 0); }), count);
}

TEST(SpecAttributePage, IsRefusedIfItDoesNotEndWithItsStreams) {
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page.is_short = true; }),
            "the page is too short");
  EXPECT_EQ(refusal_of_page([](ComposedPage& page) { page.tail = 1; }), "the page is too long");
  const std::vector<std::byte> no_head(23);
  EXPECT_THROW(decode_attribute_page(no_head, 6, composed_header(kAllBits, 2)), std::runtime_error);
}

TEST(SpecAttributePage, IsRefusedIfALinkDoesNotHaveTheFormOfOneToABlock) {
  EXPECT_EQ(refusal_of_link(kNoBlock), "");
  // Pages 0 to 2 are distance pages, page 3 has caps. A page of 4 KiB has up to 16 blocks.
  EXPECT_EQ(refusal_of_link(spec_link(true, 2, 15)), "");
  for (const SpecLink link :
       {spec_link(true, 3, 0), spec_link(true, 6, 0), spec_link(true, 0xffffffff, 0)})
    EXPECT_EQ(refusal_of_link(link), "a link beyond the distance pages");
  for (const SpecLink link : {spec_link(true, 2, 16), spec_link(true, 0, 0xffff)})
    EXPECT_EQ(refusal_of_link(link), "a link beyond the blocks of a page");
}

}  // namespace
}  // namespace planetree::golden
