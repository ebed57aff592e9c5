#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/page/frame.h"
#include "planetree/error.h"
#include "storage/file/file_layout.h"

namespace planetree::query {

/// How blocks of a file are laid out.
octree::BlockShape block_shape(const storage::ModelRecord& model) noexcept;

/// Unpacks a page of either kind into its frame.
///
/// entry   the page's, from the page table.
/// raw     its raw bytes; anything at all.
/// frame   header.page_bytes bytes, 64-byte aligned; undefined after an error.
/// errors  kDamaged: see octree/page/page_decoder.h and octree/page/mask_decoder.h.
Result<void> decode_frame(const storage::FileHeader& header, const storage::PageEntry& entry,
                          std::uint32_t page, std::span<const std::byte> raw,
                          std::span<std::byte> frame) noexcept;

/// Whether other pages are reached through the one in a frame that decode_frame() has filled.
bool leads_to_pages(const storage::FileHeader& header, std::uint32_t page,
                    std::span<const std::byte> frame) noexcept;

}  // namespace planetree::query
