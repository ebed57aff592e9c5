#pragma once

#include <cstdint>
#include <filesystem>

namespace planetree::query {

/// Numbers of pages to add to a file.
struct PageGaps {
  std::uint32_t tree = 0;  ///< between the first page of the surface's tree and its second
  std::uint32_t mask = 0;  ///< between the first page of the mask and its second
};

/// Writes a copy of a file with more pages: the pages of the model have greater numbers, and all
/// links lead to these numbers. Nothing links to the pages added. A failure ends the test program
/// with a message.
///
/// file  of float32 vertices, with indices of 4 bytes, without a field.
void spread_file(const std::filesystem::path& file, const std::filesystem::path& copy,
                 const PageGaps& gaps);

}  // namespace planetree::query
