#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "storage/file/file_layout.h"

namespace planetree::storage {

/// Blocks of the directory of a file, level by level. The blocks of the last level have an entry
/// for each page. The others have an entry for each block of the level below. Level 0 is one block,
/// the root. All blocks are full except the last one of each level.
class DirectoryShape {
 public:
  static constexpr std::uint64_t kFanOut = 512;  ///< entries of a full block
  static constexpr std::size_t kBlockBytes = kFanOut * kDirectoryEntryBytes;
  static constexpr unsigned kMaxLevels = 4;

  /// page_count  at least 1.
  explicit constexpr DirectoryShape(std::uint32_t page_count) noexcept {
    std::uint64_t entries = page_count;
    while (entries > kFanOut) {
      entries = blocks_of(entries);
      ++levels_;
    }
    entries = page_count;
    for (unsigned level = levels_; level-- > 0;) {
      entries_[level] = entries;
      entries = blocks_of(entries);
    }
  }

  [[nodiscard]] constexpr unsigned levels() const noexcept { return levels_; }
  [[nodiscard]] constexpr unsigned page_level() const noexcept { return levels_ - 1; }
  /// Entries of all blocks of a level.
  [[nodiscard]] constexpr std::uint64_t entries(unsigned level) const noexcept {
    return entries_[level];
  }
  [[nodiscard]] constexpr std::uint64_t blocks(unsigned level) const noexcept {
    return blocks_of(entries_[level]);
  }
  /// Blocks of all levels.
  [[nodiscard]] constexpr std::uint64_t blocks() const noexcept {
    std::uint64_t sum = 0;
    for (unsigned level = 0; level < levels_; ++level) sum += blocks(level);
    return sum;
  }
  /// Entries of one block of a level.
  [[nodiscard]] constexpr std::size_t block_entries(unsigned level,
                                                    std::uint64_t block) const noexcept {
    return static_cast<std::size_t>(std::min(kFanOut, entries_[level] - block * kFanOut));
  }
  /// Offset of a block from the start of the directory.
  [[nodiscard]] constexpr std::uint64_t block_offset(unsigned level,
                                                     std::uint64_t block) const noexcept {
    std::uint64_t before = block * kFanOut;
    for (unsigned above = 0; above < level; ++above) before += entries_[above];
    return before * kDirectoryEntryBytes;
  }
  [[nodiscard]] constexpr std::uint64_t bytes() const noexcept {
    return block_offset(page_level(), 0) + entries_[page_level()] * kDirectoryEntryBytes;
  }
  /// Number of the block of a level that leads to a page.
  [[nodiscard]] constexpr std::uint64_t block_of_page(unsigned level,
                                                      std::uint32_t page) const noexcept {
    std::uint64_t block = page / kFanOut;
    for (unsigned below = page_level(); below > level; --below) block /= kFanOut;
    return block;
  }

 private:
  static constexpr std::uint64_t blocks_of(std::uint64_t entries) noexcept {
    return (entries + kFanOut - 1) / kFanOut;
  }

  unsigned levels_ = 1;
  std::uint64_t entries_[kMaxLevels] = {};
};

/// Offset of the directory in the file.
[[nodiscard]] constexpr std::uint64_t directory_start(std::uint32_t extension_count) noexcept {
  return kHeaderBytes + std::uint64_t{extension_count} * sizeof(ExtensionRecord);
}

/// Offset of a block of the directory in the file.
[[nodiscard]] constexpr std::uint64_t directory_block_start(const FileHeader& header,
                                                            const DirectoryShape& shape,
                                                            unsigned level,
                                                            std::uint64_t block) noexcept {
  return directory_start(header.extension_count) + shape.block_offset(level, block);
}

/// Offset of page 0 in the file.
[[nodiscard]] inline std::uint64_t pages_start(const FileHeader& header) noexcept {
  return directory_start(header.extension_count) + DirectoryShape(header.page_count).bytes();
}

/// Offset at which the last page ends.
[[nodiscard]] inline std::uint64_t pages_end(const FileHeader& header) noexcept {
  return pages_start(header) + header.stored_page_bytes();
}

}  // namespace planetree::storage
