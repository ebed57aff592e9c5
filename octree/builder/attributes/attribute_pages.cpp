#include "octree/builder/attributes/attribute_pages.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "octree/builder/tree/stream_writer.h"

namespace planetree::octree {
namespace {

using Bytes = std::vector<std::byte>;

// Appends a stream of the records, whose elements of `element_bytes` each are split. It is
// `stream_bytes` long in a record and begins at `at`.
void split(const Bytes& records, std::size_t record_bytes, std::size_t at, std::size_t stream_bytes,
           std::size_t element_bytes, StreamWriter& out) {
  const std::size_t count = records.size() / record_bytes;
  const std::size_t in_record = stream_bytes / element_bytes;
  Bytes stream(count * stream_bytes);
  std::size_t to = 0;
  for (std::size_t k = 0; k < element_bytes; ++k)
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t element = 0; element < in_record; ++element)
        stream[to++] = records[i * record_bytes + at + element * element_bytes + k];
  out.plain(stream.data(), stream.size());
}

// Appends the page and the number in it of each block.
void add_links(std::span<const std::uint32_t> links, std::uint32_t page_bytes, StreamWriter& out) {
  const LinkFormat format = LinkFormat::numbered(page_bytes);
  std::vector<std::uint32_t> pages;
  std::vector<std::uint16_t> numbers;
  for (const std::uint32_t link : links) {
    const bool is_none = link == kNoLink;
    pages.push_back(is_none ? kNoStoredLink.page : format.page(link));
    numbers.push_back(is_none ? kNoStoredLink.record
                              : static_cast<std::uint16_t>(format.record(link)));
  }
  out.byte_split(pages);
  out.byte_split(numbers);
}

}  // namespace

KeptAttributes KeptAttributes::of(const OrderedMesh& mesh, const BuildOptions& options,
                                  const storage::SpillFile& file) {
  return {{options.kept_attributes()},
          mesh.frame.triangle_count + mesh.frame.skipped_count,
          mesh.value_kind,
          mesh.attributes,
          &file};
}

std::uint64_t KeptAttributes::page_count(std::uint32_t page_bytes) const {
  if (shape.kept == 0) return 0;
  return (index_count - 1) / shape.triangles_per_page(page_bytes) + 1;
}

void KeptAttributes::describe(std::uint32_t page_bytes, storage::ModelRecord& model) const {
  model.attributes = static_cast<std::uint8_t>(shape.kept);
  if (shape.has_values()) model.value_kind = static_cast<storage::ValueKind>(value_kind);
  model.attribute_page_count = static_cast<std::uint32_t>(page_count(page_bytes));
}

Result<void> AttributePages::append_to(PageAppender& appender, std::uint32_t first_page) {
  const auto count = static_cast<std::uint32_t>(kept_.page_count(page_bytes_));
  const std::uint32_t in_bucket = links_.pages_per_bucket();
  const std::uint32_t in_page = kept_.shape.triangles_per_page(page_bytes_);
  for (std::uint32_t first = 0; first < count; first += in_bucket) {
    const auto links = links_.links(first / in_bucket);
    if (!links) return links.error();
    const auto appended = appender.append(std::min(in_bucket, count - first), [&](std::uint32_t i) {
      const std::size_t begin = std::size_t{i} * in_page;
      const std::size_t some = std::min<std::size_t>(in_page, links->size() - begin);
      return encode(first + i, first_page, std::span(*links).subspan(begin, some));
    });
    if (!appended) return appended;
  }
  return {};
}

Result<FilePage> AttributePages::encode(std::uint32_t index, std::uint32_t first_page,
                                        std::span<const std::uint32_t> links) const {
  AttributePageHead head{};
  head.page_number = first_page + index;
  head.ordinal = index;
  head.triangle_count = static_cast<std::uint32_t>(links.size());
  StreamWriter bytes;
  bytes.plain(&head, sizeof head);
  add_links(links, page_bytes_, bytes);
  const AttributeShape& shape = kept_.shape;
  if (const std::size_t record_bytes = shape.extra_bytes(); record_bytes > 0) {
    Bytes records(links.size() * record_bytes);
    const std::uint64_t first = std::uint64_t{index} * shape.triangles_per_page(page_bytes_);
    const auto read = kept_.spooled.read(*kept_.file, first, records);
    if (!read) return read.error();
    std::size_t at = 0;
    const auto add = [&](std::size_t stream_bytes, std::size_t element_bytes) {
      split(records, record_bytes, at, stream_bytes, element_bytes, bytes);
      at += stream_bytes;
    };
    if (shape.has_colors()) add(AttributeShape::kColorBytes, AttributeShape::kColorBytes);
    if (shape.has_uvs()) add(AttributeShape::kUvBytes, sizeof(float));
    if (shape.has_values()) add(AttributeShape::kValueBytes, AttributeShape::kValueBytes);
  }
  FilePage page;
  page.ordinal = index;
  page.bytes = bytes.take();
  return page;
}

}  // namespace planetree::octree
