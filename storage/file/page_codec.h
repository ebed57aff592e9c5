#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "planetree/error.h"
#include "storage/file/file_layout.h"

/// Converts raw bytes of a page to stored bytes and back. No other file of the library uses LZ4.
namespace planetree::storage {

/// Maximum number of raw bytes of a page. Larger pages are refused before memory is allocated.
inline constexpr std::size_t kMaxRawBytes = 4 * std::size_t{kMaxPageBytes};

struct StoredPage {
  Codec codec;
  std::vector<std::byte> bytes;
};

/// Compresses a page to an LZ4 block, or copies it if LZ4 does not make it shorter.
///
/// raw      1 to kMaxRawBytes bytes.
/// return   depends on `raw` and the release of LZ4 alone, not on threads, memory or earlier calls.
/// throws   std::bad_alloc.
/// threads  any number at once.
[[nodiscard]] StoredPage compress_page(std::span<const std::byte> raw);

/// Whether a page can have these lengths. Without a codec, stored and raw length are equal. An LZ4
/// block is shorter than the raw bytes, by a factor of at most 255. Readers allocate nothing for a
/// page that fails this check, so that no file can be a decompression bomb.
[[nodiscard]] bool lengths_are_plausible(Codec codec, std::uint64_t stored_bytes,
                                         std::uint64_t raw_bytes) noexcept;

/// Restores the raw bytes of a page.
///
/// stored   any bytes, even hostile ones.
/// raw_out  exactly as long as the raw page; overwritten even on failure. Must not overlap
///          `stored`.
/// errors   kDamaged: `stored` does not give a page of this length, or the codec is unknown.
/// threads  any number at once; no allocation.
Result<void> decompress_page(Codec codec, std::span<const std::byte> stored,
                             std::span<std::byte> raw_out) noexcept;

}  // namespace planetree::storage
