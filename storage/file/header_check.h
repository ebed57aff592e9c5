#pragma once

#include <cstdint>
#include <span>

#include "planetree/error.h"
#include "storage/file/file_layout.h"

/// Rules of the format for the header and the page table. The reader refuses a file that breaks a
/// rule, and the writer checks its own header and table before it commits the file.
///
/// The arguments must be copies that no other process can change. The functions read nothing else
/// and allocate nothing. The hashes prove only that the bytes are those that were written. The
/// rules are checked in addition, because a hostile file may have correct hashes.
namespace planetree::storage {

/// Checks all fields of a header except its own hash.
///
/// actual_bytes  length of the file.
/// errors        kUnsupported; kTruncated, which states the expected and the actual length;
///               kDamaged.
Result<void> check_header(const FileHeader& header, std::uint64_t actual_bytes) noexcept;

/// Checks the fields of a model record against each other. Fields that describe the tree can only
/// be checked by code that reads the tree.
/// errors  kDamaged.
Result<void> check_model(const ModelRecord& model) noexcept;

/// Checks a page table against its header, which must have passed check_header(): the hashes, the
/// order of keys, the lengths, and that the pages fill the file from the table to the header's copy
/// without gaps or overlaps.
/// errors  kDamaged.
Result<void> check_table(const FileHeader& header, std::span<const PageEntry> entries) noexcept;

/// Offset at which the page table ends and page 0 starts.
[[nodiscard]] constexpr std::uint64_t table_end(std::uint32_t page_count) noexcept {
  return kHeaderBytes + std::uint64_t{page_count} * sizeof(PageEntry);
}

}  // namespace planetree::storage
