#pragma once

#include <cstdint>

#include "storage/file/file_layout.h"

/// Frames of a scene, which the pages of several files share.
namespace planetree::query {

/// Most raw bytes of a page that goes into frames of `page_bytes`. Lists of the mask can be longer
/// in a file than in memory, by less than half.
constexpr std::uint32_t max_raw_bytes(std::uint32_t page_bytes) noexcept {
  return page_bytes + page_bytes / 2;
}

/// Least size of frames that take the pages of a file: a power of two.
constexpr std::uint32_t frame_bytes_for(const storage::FileHeader& header) noexcept {
  std::uint32_t bytes = header.page_bytes;
  while (max_raw_bytes(bytes) < header.max_raw_bytes) bytes *= 2;
  return bytes;
}

}  // namespace planetree::query
