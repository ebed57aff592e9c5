#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "storage/file/checksum.h"
#include "storage/file/file_layout.h"

/// Hashes of a .ptree file, shared by writer and reader.
///
///   page hash    of a page's stored bytes, seeded with its number: swapped pages fail
///   content id   of all page hashes: identifies the content of the file
///   page check   page hash exclusive-or the content id's low word: pages of other files fail
///   table hash   of the page table
///   header hash  of the header, which holds the content id and the table hash
namespace planetree::storage {

/// page    page number.
/// stored  stored bytes of the page.
[[nodiscard]] std::uint64_t page_hash(std::uint32_t page,
                                      std::span<const std::byte> stored) noexcept;

/// Content id of pages whose `check` fields hold the page hashes exclusive-or `mask`.
[[nodiscard]] Hash128 content_id(std::span<const PageEntry> entries, std::uint64_t mask) noexcept;

[[nodiscard]] std::uint64_t table_hash(std::span<const PageEntry> entries) noexcept;

[[nodiscard]] std::uint64_t header_hash(const FileHeader& header) noexcept;

}  // namespace planetree::storage
