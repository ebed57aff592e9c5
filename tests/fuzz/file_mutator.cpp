#include "tests/fuzz/file_mutator.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <utility>

namespace planetree::storage {
namespace {

using octree::StreamPage;

// Fields of one width that follow each other in the model record.
struct Fields {
  std::size_t offset, width, count;
};
constexpr Fields kModelFields[] = {{offsetof(ModelRecord, triangle_count), 8, 6},
                                   {offsetof(ModelRecord, box_lower), 8, 12},
                                   {offsetof(ModelRecord, sample_triangle), 8, 1},
                                   {offsetof(ModelRecord, scale_exponent), 4, 1},
                                   {offsetof(ModelRecord, vertex_kind), 1, 3},
                                   {offsetof(ModelRecord, unbalanced_edge_count), 8, 1},
                                   {offsetof(ModelRecord, unbalanced_edge), 8, 7},
                                   {offsetof(ModelRecord, mask_cell_count), 8, 1},
                                   {offsetof(ModelRecord, mask_page_count), 4, 1},
                                   {offsetof(ModelRecord, mask_levels), 1, 1},
                                   {offsetof(ModelRecord, input_triangles), 8, 8},
                                   {offsetof(ModelRecord, field_lower), 8, 5},
                                   {offsetof(ModelRecord, field_size), 4, 4},
                                   {offsetof(ModelRecord, attribute_page_count), 4, 1},
                                   {offsetof(ModelRecord, attributes), 1, 2}};

}  // namespace

Bytes FileMutator::mutate(ForgedFile file) {
  for (std::size_t changes = 1 + choices_.below(4); changes > 0; --changes) change(file);
  return seal(file);
}

Bytes FileMutator::cross(ForgedFile file, const ForgedFile& other) {
  if (choices_.one_in(4)) file.header.model = other.header.model;
  for (ForgedPage& page : file.pages)
    if (choices_.one_in(2)) page.raw = choices_.of(other.pages).raw;
  number_pages(file);
  return seal(file);
}

void FileMutator::change(ForgedFile& file) {
  const std::size_t page = choices_.below(file.pages.size());
  switch (choices_.below(12)) {
    case 0:
    case 1:
      return change_header(file.header);
    case 2:
      return change_pages(file);
    case 3:
      return change_key(file.pages[page]);
    default:
      return change_content(file, page);
  }
}

void FileMutator::change_header(FileHeader& header) {
  const auto bytes = std::as_writable_bytes(std::span(&header, 1));
  if (choices_.one_in(8)) {
    header.page_bytes = kMinPageBytes << choices_.below(5);
  } else if (choices_.one_in(8)) {
    change_value(
        bytes.subspan(offsetof(FileHeader, incompatible_features) + 8 * choices_.below(2), 8),
        choices_);
  } else {
    const Fields& fields = choices_.of(kModelFields);
    change_value(bytes.subspan(offsetof(FileHeader, model) + fields.offset +
                                   choices_.below(fields.count) * fields.width,
                               fields.width),
                 choices_);
  }
}

void FileMutator::change_pages(ForgedFile& file) {
  const std::size_t page = choices_.below(file.pages.size());
  const std::size_t other = choices_.below(file.pages.size());
  const auto at = file.pages.begin() + static_cast<std::ptrdiff_t>(page);
  switch (choices_.below(4)) {
    case 0:
      if (file.pages.size() > 1) file.pages.erase(at);
      break;
    case 1:
      if (file.pages.size() < ForgedFile::kMaxPages) {
        const ForgedPage copy = file.pages[other];
        file.pages.insert(at, copy);
      }
      break;
    case 2:
      std::swap(file.pages[page].raw, file.pages[other].raw);
      break;
    default:
      file.pages[page].raw = file.pages[other].raw;
  }
  number_pages(file);
}

// The key is that of the page's head as well, unless the head is left behind.
void FileMutator::change_key(ForgedPage& page) {
  change_value(std::as_writable_bytes(std::span(&page.octcode, 1)), choices_);
  if (page.raw.size() < StreamPage::kHeadBytes || choices_.one_in(8)) return;
  std::memcpy(page.raw.data() + 8, &page.octcode, sizeof page.octcode);
}

void FileMutator::change_content(ForgedFile& file, std::size_t page) {
  Bytes& raw = file.pages[page].raw;
  std::optional<StreamPage> streams = StreamPage::of(raw, file.is_mask(page), file.shape());
  if (!streams) {
    if (!raw.empty()) change_value(std::span(raw).subspan(choices_.below(raw.size()), 1), choices_);
    return;
  }
  change_streams(file, *streams);
  if (!choices_.one_in(4)) streams->fit_head();
  if (!choices_.one_in(8)) streams->fit_streams();
  Bytes changed = streams->bytes();
  if (changed.size() <= StreamPage::kMaxBytes) raw = std::move(changed);
}

void FileMutator::change_streams(const ForgedFile& file, StreamPage& page) {
  const std::size_t count = choices_.below(StreamPage::kCounts);
  octree::PageStream& stream = choices_.of(page.streams());
  switch (choices_.below(10)) {
    case 0: {
      const std::size_t at = 16 + choices_.below(12) * 2;
      return change_value(std::span(page.head()).subspan(at, 2), choices_);
    }
    case 1:
      return page.repeat_record(count, choices_.below(page.count(count) + std::size_t{1}));
    case 2:
      return page.erase_record(count, choices_.below(page.count(count) + std::size_t{1}));
    case 3:
    case 4: {
      const std::size_t at = choices_.one_in(2) ? page.linked_pages() : page.block_pages();
      octree::PageStream& pages = page.streams()[at];
      octree::PageStream& records = page.streams()[at + 1];
      if (pages.width != 4 || pages.size() == 0 || records.size() != pages.size()) return;
      const std::size_t link = choices_.below(pages.size());
      return change_link(file, pages.element(link), records.element(link));
    }
    case 5:
      if (stream.size() > 0) {
        const auto from = stream.element(choices_.below(stream.size()));
        std::ranges::copy(from, stream.element(choices_.below(stream.size())).begin());
      }
      return;
    default:
      if (stream.size() > 0) change_value(stream.element(choices_.below(stream.size())), choices_);
  }
}

// A link to one of the first records of a page.
void FileMutator::change_link(const ForgedFile& file, std::span<std::byte> page,
                              std::span<std::byte> record) {
  if (choices_.one_in(4)) return change_value(choices_.one_in(2) ? page : record, choices_);
  const auto to = static_cast<std::uint32_t>(choices_.below(file.pages.size() + 1));
  const auto number = static_cast<std::uint16_t>(choices_.below(12));
  std::memcpy(page.data(), &to, page.size());
  std::memcpy(record.data(), &number, record.size());
}

// Heads state the number of their page and its key, which ascend.
void FileMutator::number_pages(ForgedFile& file) {
  for (std::size_t page = 0; page < file.pages.size(); ++page) {
    ForgedPage& it = file.pages[page];
    const auto number = static_cast<std::uint32_t>(page);
    if (page > 0) it.octcode = std::max(it.octcode, file.pages[page - 1].octcode);
    if (it.raw.size() < StreamPage::kHeadBytes) continue;
    std::memcpy(it.raw.data(), &number, sizeof number);
    std::memcpy(it.raw.data() + 8, &it.octcode, sizeof it.octcode);
  }
}

// In one file of some, a length or an offset is wrong under right hashes.
Bytes FileMutator::seal(const ForgedFile& file) {
  Bytes bytes = file.bytes();
  if (!choices_.one_in(16)) return bytes;
  FileImage image(std::move(bytes));
  if (choices_.one_in(3)) {
    image.change_header([&](FileHeader& header) {
      change_value(std::as_writable_bytes(std::span(&header.max_raw_bytes, 1)), choices_);
    });
  } else {
    const auto page = static_cast<std::uint32_t>(choices_.below(file.pages.size()));
    image.change_entry(page, [&](DirectoryPage& entry) {
      constexpr Fields kEntry[] = {{offsetof(DirectoryPage, octcode), 8, 1},
                                   {offsetof(DirectoryPage, stored_bytes), 4, 1},
                                   {offsetof(DirectoryPage, raw_bytes), 4, 1}};
      const Fields& field = choices_.of(kEntry);
      change_value(std::as_writable_bytes(std::span(&entry, 1)).subspan(field.offset, field.width),
                   choices_);
    });
  }
  image.seal();
  return std::move(image.bytes());
}

}  // namespace planetree::storage
