#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "octree/attributes/attribute_page.h"
#include "octree/field/field_shape.h"
#include "octree/page/frame.h"
#include "octree/page/page_decoder.h"
#include "planetree/error.h"
#include "storage/file/file_layout.h"

namespace planetree::query {

/// Returns the layout of the nodes and blocks of a file's surface, and of its caps.
octree::BlockShape block_shape(const storage::FileHeader& header) noexcept;
octree::BlockShape cap_shape(const storage::FileHeader& header) noexcept;

/// Returns the grid of a file's coarse field; without points if it has none.
octree::FieldShape field_shape(const storage::ModelRecord& model) noexcept;

/// Returns the number of grid points in a field page.
std::size_t field_points(const storage::FileHeader& header, std::uint32_t page) noexcept;

/// Returns what a file's attribute pages have for each triangle.
octree::AttributeShape attribute_shape(const storage::ModelRecord& model) noexcept;

/// Returns the number of triangles in an attribute page.
std::uint32_t attribute_triangles(const storage::FileHeader& header, std::uint32_t page) noexcept;

/// Returns what decoding a page needs.
///
/// page  page number, below header.page_count
octree::PageInfo page_info(const storage::FileHeader& header, const storage::PageEntry& entry,
                           std::uint32_t page) noexcept;

/// Decodes a page of any kind into its frame.
///
/// info    page_info() of the page; the caller may choose what the links of a tree lead to
/// raw     raw bytes of the page; any bytes are allowed
/// frame   header.page_bytes bytes, aligned to 64 bytes; undefined after an error
/// errors  kDamaged: see octree/page/page_decoder.h, octree/field/field_page.h and
///         octree/attributes/attribute_page.h
Result<void> decode_frame(const storage::FileHeader& header, const octree::PageInfo& info,
                          std::span<const std::byte> raw, std::span<std::byte> frame) noexcept;

/// Returns whether a page has links to other pages.
///
/// frame  filled by decode_frame()
bool leads_to_pages(const storage::FileHeader& header, std::uint32_t page,
                    std::span<const std::byte> frame) noexcept;

}  // namespace planetree::query
