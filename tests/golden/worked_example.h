#pragma once

#include <cstddef>
#include <span>
#include <string>

/// The listings of the specification's "Worked example": lines of an offset,
/// bytes, and what they are.
namespace planetree::golden {

/// A whole file; its pages as LZ4 sequences.
std::string list_file(std::span<const std::byte> file);

/// The raw bytes of a page of blocks with f32 vertices and 4-byte indices.
std::string list_page(std::span<const std::byte> raw);

}  // namespace planetree::golden
