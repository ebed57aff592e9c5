#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "planetree/error.h"

namespace planetree::storage {

/// Reads bytes from front to back, in parts of up to 1 MiB.
///
/// source  has read_at(offset, bytes), as FileHandle and ByteSource
/// bytes   number of bytes from its start on
/// take    called with each part; its bytes are valid until it returns
/// errors  those of read_at()
template <class Source, class Take>
Result<void> read_parts(const Source& source, std::uint64_t bytes, const Take& take) {
  constexpr std::uint64_t kPartBytes = std::uint64_t{1} << 20;
  std::vector<std::byte> memory(static_cast<std::size_t>(std::min(kPartBytes, bytes)));
  for (std::uint64_t at = 0; at < bytes; at += memory.size()) {
    const auto part = std::span(memory).first(
        static_cast<std::size_t>(std::min<std::uint64_t>(memory.size(), bytes - at)));
    if (const auto read = source.read_at(at, part); !read) return read;
    take(std::span<const std::byte>(part));
  }
  return {};
}

}  // namespace planetree::storage
