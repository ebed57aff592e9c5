#include "tests/fuzz/forged_file.h"

#include <algorithm>

#include "storage/file/page_codec.h"

namespace planetree::storage {
namespace {

std::optional<ForgedPage> read_page(FileImage& image, std::uint32_t page) {
  const DirectoryPage entry = image.entry(page);
  const std::size_t file_bytes = image.bytes().size(), offset = image.offset_of_page(page);
  if (offset > file_bytes || entry.stored_bytes > file_bytes - offset) return {};
  const Codec codec = entry.stored_bytes == entry.raw_bytes ? Codec::kStored : Codec::kLz4;
  if (entry.raw_bytes > kMaxRawBytes ||
      !lengths_are_plausible(codec, entry.stored_bytes, entry.raw_bytes))
    return {};
  ForgedPage read{entry.octcode, Bytes(entry.raw_bytes)};
  if (!decompress_page(codec, image.stored(page), read.raw)) return {};
  return read;
}

}  // namespace

std::optional<ForgedFile> ForgedFile::of(std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderBytes) return {};
  FileImage image(Bytes(bytes.begin(), bytes.end()));
  ForgedFile file{image.header(), {}};
  const std::uint32_t page_count = file.header.page_count;
  if (page_count == 0 || page_count > kMaxPages || !image.directory_fits()) return {};
  for (std::uint32_t page = 0; page < file.header.page_count; ++page) {
    std::optional<ForgedPage> read = read_page(image, page);
    if (!read) return {};
    file.pages.push_back(*std::move(read));
  }
  return file;
}

Bytes ForgedFile::bytes() const {
  const auto page_count = static_cast<std::uint32_t>(pages.size());
  FileHeader stated = header;
  stated.page_count = page_count;
  stated.extension_count = 0;
  Bytes result(kHeaderBytes + DirectoryShape(page_count).bytes());
  std::vector<DirectoryPage> entries;
  std::ranges::fill(stated.stored_bytes, 0);
  stated.max_raw_bytes = 0;
  stated.max_stored_bytes = 0;
  for (const ForgedPage& page : pages) {
    const StoredPage stored = compress_page(page.raw);
    DirectoryPage entry{};
    entry.octcode = page.octcode;
    entry.stored_bytes = static_cast<std::uint32_t>(stored.bytes.size());
    entry.raw_bytes = static_cast<std::uint32_t>(page.raw.size());
    const PageKind kind = stated.kind_of(static_cast<std::uint32_t>(entries.size()));
    stated.stored_bytes[static_cast<unsigned>(kind)] += entry.stored_bytes;
    entries.push_back(entry);
    result.insert(result.end(), stored.bytes.begin(), stored.bytes.end());
    stated.max_raw_bytes = std::max(stated.max_raw_bytes, entry.raw_bytes);
    stated.max_stored_bytes = std::max(stated.max_stored_bytes, entry.stored_bytes);
  }
  result.resize(result.size() + kHeaderBytes);
  stated.file_bytes = result.size();
  FileImage image(std::move(result));
  image.set_header(stated);
  for (std::uint32_t page = 0; page < page_count; ++page) image.set_entry(page, entries[page]);
  image.seal();
  return std::move(image.bytes());
}

octree::BlockShape ForgedFile::shape() const {
  return {header.model.vertex_kind == VertexKind::kFloat64, header.model.triangle_id_bytes == 8,
          header.model.unbalanced_edge_count != 0};
}

}  // namespace planetree::storage
