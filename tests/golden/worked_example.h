#pragma once

#include <cstddef>
#include <span>
#include <string>

/// The listings of the specification's "Worked example": lines with an offset, bytes and their
/// meaning.
namespace planetree::golden {

/// Lists a whole file of at most 512 pages without extensions, with its pages as LZ4 sequences.
std::string list_file(std::span<const std::byte> file);

/// Lists the raw bytes of a page of blocks with f32 vertices and 4-byte indices.
std::string list_page(std::span<const std::byte> raw);

}  // namespace planetree::golden
