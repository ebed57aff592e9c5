#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "planetree/error.h"
#include "storage/file/directory_shape.h"
#include "storage/file/file_layout.h"

namespace planetree::storage {

/// A block of the directory, and what the block above it states of it.
struct DirectoryPlace {
  unsigned level = 0;
  std::uint64_t block = 0;
  std::uint64_t check = 0;    ///< XXH3-64 of its bytes; not of the root
  std::uint64_t octcode = 0;  ///< of its first page; not of the root
  std::uint64_t start = 0;    ///< where its first page starts, from page 0 on
  std::uint64_t end = 0;      ///< where its last page ends

  /// The root of a file's directory.
  static DirectoryPlace root(const FileHeader& header) noexcept {
    DirectoryPlace place;
    place.end = header.stored_page_bytes();
    return place;
  }
};

/// Copies an entry of a block.
template <class Entry>
Entry directory_entry(std::span<const std::byte> block, std::size_t index) noexcept {
  static_assert(sizeof(Entry) == kDirectoryEntryBytes);
  Entry entry;
  std::memcpy(&entry, block.data() + index * sizeof entry, sizeof entry);
  return entry;
}

/// What the entry of a page says of a page that starts at `offset` in the file.
inline PageEntry page_entry(const DirectoryPage& page, std::uint64_t offset) noexcept {
  return {offset, page.check, page.octcode, page.stored_bytes, page.raw_bytes};
}

/// What a block of an upper level states of its entry `index`.
[[nodiscard]] DirectoryPlace place_below(const DirectoryShape& shape, const DirectoryPlace& place,
                                         std::span<const std::byte> block,
                                         std::size_t index) noexcept;

/// Checks a block of the directory against what is stated of it: its hash, that what is below it
/// fills the range from place.start to place.end without gaps or overlaps, and the lengths of its
/// pages. The bytes must be a copy that no other process can change.
///
/// header  must have passed check_header()
/// errors  kDamaged
Result<void> check_directory_block(const FileHeader& header, const DirectoryShape& shape,
                                   const DirectoryPlace& place,
                                   std::span<const std::byte> bytes) noexcept;

}  // namespace planetree::storage
