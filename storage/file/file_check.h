#pragma once

#include <cstdint>
#include <span>

#include "planetree/error.h"
#include "storage/file/file_layout.h"

/// The rules a header and a page table keep. The reader refuses a file that
/// breaks one; the writer holds its own work against them before it commits.
///
/// All take copies that no other process can change, read nothing else, and
/// allocate nothing. The hashes prove that bytes are as they were written; the
/// rules are checked all the same, for a hash is no proof of good intent.
namespace planetree::storage {

/// Everything a header says, but its own hash.
///
/// actual_bytes  the file's true length.
/// errors        kUnsupported, kTruncated (says expected and found length), kDamaged.
Result<void> check_header(const FileHeader& header, std::uint64_t actual_bytes) noexcept;

/// What a header says of the model. Only what stands by itself: what the tree
/// holds is for those to check who read it.
Result<void> check_model(const ModelRecord& model) noexcept;

/// The page table against its header, which must have passed check_header():
/// hashes, the order of keys, lengths, and that the pages fill the file
/// without gap or overlap from the table to the header's copy.
Result<void> check_table(const FileHeader& header, std::span<const PageEntry> entries) noexcept;

/// Where page 0 starts.
[[nodiscard]] constexpr std::uint64_t table_end(std::uint32_t page_count) noexcept {
  return kHeaderBytes + std::uint64_t{page_count} * sizeof(PageEntry);
}

}  // namespace planetree::storage
