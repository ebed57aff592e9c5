#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "storage/file/checksum.h"
#include "storage/file/directory_shape.h"
#include "storage/file/file_layout.h"

namespace planetree::storage {

/// Makes the upper levels of a directory from the entries of the pages.
class DirectoryWriter {
 public:
  /// header  page_count is set.
  /// pages   one entry for each page; must outlive the object.
  DirectoryWriter(const FileHeader& header, std::span<const DirectoryPage> pages);

  const DirectoryShape& shape() const noexcept { return shape_; }
  /// Bytes of all blocks of a level, one after the other.
  std::span<const std::byte> level(unsigned level) const noexcept;
  /// Hash of the root, which is FileHeader::content_id.
  Hash128 content_id() const noexcept { return hash128(level(0)); }

 private:
  void add_first_level();
  void add_level(unsigned level);
  std::span<const std::byte> block(unsigned level, std::uint64_t number) const noexcept;

  const DirectoryShape shape_;
  const std::span<const DirectoryPage> pages_;
  std::vector<DirectoryBlock> upper_[DirectoryShape::kMaxLevels];
};

}  // namespace planetree::storage
