#include "storage/file/directory_writer.h"

namespace planetree::storage {

DirectoryWriter::DirectoryWriter(const FileHeader& header, std::span<const DirectoryPage> pages)
    : shape_(header.page_count), pages_(pages) {
  if (shape_.page_level() == 0) return;
  add_first_level();
  for (unsigned level = shape_.page_level() - 1; level-- > 0;) add_level(level);
}

// The level above the pages.
void DirectoryWriter::add_first_level() {
  std::uint64_t offset = 0;
  for (std::uint64_t i = 0; i < shape_.blocks(shape_.page_level()); ++i) {
    const std::size_t count = shape_.block_entries(shape_.page_level(), i);
    const auto pages = pages_.subspan(i * DirectoryShape::kFanOut, count);
    const std::uint64_t check = hash64(block(shape_.page_level(), i));
    upper_[shape_.page_level() - 1].push_back({check, pages.front().octcode, offset});
    for (const DirectoryPage& page : pages) offset += page.stored_bytes;
  }
}

void DirectoryWriter::add_level(unsigned level) {
  const std::vector<DirectoryBlock>& below = upper_[level + 1];
  for (std::uint64_t i = 0; i < shape_.blocks(level + 1); ++i) {
    const DirectoryBlock& first = below[i * DirectoryShape::kFanOut];
    upper_[level].push_back({hash64(block(level + 1, i)), first.octcode, first.offset});
  }
}

std::span<const std::byte> DirectoryWriter::level(unsigned level) const noexcept {
  return level == shape_.page_level() ? std::as_bytes(pages_)
                                      : std::as_bytes(std::span(upper_[level]));
}

std::span<const std::byte> DirectoryWriter::block(unsigned level,
                                                  std::uint64_t number) const noexcept {
  return this->level(level).subspan(number * DirectoryShape::kBlockBytes,
                                    shape_.block_entries(level, number) * kDirectoryEntryBytes);
}

}  // namespace planetree::storage
