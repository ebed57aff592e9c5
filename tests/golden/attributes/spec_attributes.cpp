#include "tests/golden/attributes/spec_attributes.h"

#include <algorithm>
#include <cstring>

#include "tests/golden/spec_streams.h"

namespace planetree::golden {
namespace {

struct AttributeHead {
  std::uint32_t page_number, ordinal;
  std::uint64_t octcode;
  std::uint32_t triangle_count, reserved;
};
static_assert(sizeof(AttributeHead) == 24);

// The number of triangles in the page of this rank: the last page has the rest.
std::uint64_t triangles_of_page(std::uint64_t rank, const SpecHeader& header) {
  const std::uint64_t in_page = header.attribute_page_triangles();
  require(rank * in_page < header.indices(), "an attribute page without triangles");
  return std::min(in_page, header.indices() - rank * in_page);
}

// By its form, a link leads to a block of a distance page.
void check_link(SpecLink link, const SpecHeader& header) {
  if (link == kNoBlock) return;
  require(page_of_link(link) < header.c(), "a link beyond the distance pages");
  require((link & 0xffff) < header.page_bytes / 256, "a link beyond the blocks of a page");
}

std::vector<SpecUvs> uvs_of(const std::vector<float>& coordinates) {
  std::vector<SpecUvs> uvs(coordinates.size() / 6);
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    uvs[i / 6][i % 6 / 2][i % 2] = coordinates[i];
  return uvs;
}

template <class T>
void append_list(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

SpecAttributeLists decode_attribute_page(std::span<const std::byte> raw, std::uint32_t number,
                                         const SpecHeader& header) {
  StreamReader streams(raw);
  AttributeHead head{};
  std::memcpy(&head, streams.bytes(sizeof head).data(), sizeof head);
  const std::uint32_t rank = number - header.a();
  require(head.page_number == number, "another page");
  require(head.ordinal == rank && head.octcode == 0, "key of an attribute page");
  require(head.triangle_count == triangles_of_page(rank, header), "triangles of an attribute page");
  require(head.reserved == 0, "reserved bytes of an attribute page");

  const std::size_t count = head.triangle_count;
  SpecAttributeLists page;
  const auto pages = streams.byte_split<std::uint32_t>(count);
  const auto blocks = streams.byte_split<std::uint16_t>(count);
  for (std::size_t i = 0; i < count; ++i)
    page.links.push_back(spec_link(true, pages[i], blocks[i]));
  if (header.has_attribute(1)) page.colours = streams.byte_split<SpecColours>(count);
  if (header.has_attribute(2)) page.uvs = uvs_of(streams.byte_split<float>(6 * count));
  if (header.has_attribute(3)) page.values = streams.byte_split<std::uint64_t>(count);
  require(streams.empty(), "the page is too long");
  for (const SpecLink link : page.links) check_link(link, header);
  return page;
}

SpecAttributes::SpecAttributes(const SpecFile& file) {
  const SpecHeader& header = file.header();
  for (std::uint32_t number = header.a(); number < header.d(); ++number) {
    const SpecAttributeLists page = decode_attribute_page(file.raw_page(number), number, header);
    append_list(lists_.links, page.links);
    append_list(lists_.colours, page.colours);
    append_list(lists_.uvs, page.uvs);
    append_list(lists_.values, page.values);
  }
  require(size() == (header.attributes == 0 ? 0 : header.indices()), "indices with attributes");
}

}  // namespace planetree::golden
