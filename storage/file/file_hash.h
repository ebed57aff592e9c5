#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "storage/file/checksum.h"
#include "storage/file/file_layout.h"

/// The hashes a .ptree file carries, each in one place for writer and reader.
///
///   page hash    over a page's stored bytes, seeded with its number: swapped pages fail
///   content id   over all page hashes: the name of this content
///   page check   page hash exclusive-or the content id: pages of other files fail
///   table hash   over the page table
///   header hash  over the header, which holds the content id and the table hash
namespace planetree::storage {

[[nodiscard]] std::uint64_t page_hash(std::uint32_t page,
                                      std::span<const std::byte> stored) noexcept;

/// The content id of pages whose `check` fields hold page hashes exclusive-or `mask`.
[[nodiscard]] Hash128 content_id(std::span<const PageEntry> entries, std::uint64_t mask) noexcept;

[[nodiscard]] std::uint64_t table_hash(std::span<const PageEntry> entries) noexcept;

[[nodiscard]] std::uint64_t header_hash(const FileHeader& header) noexcept;

}  // namespace planetree::storage
