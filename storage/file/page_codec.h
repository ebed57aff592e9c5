#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "planetree/error.h"
#include "storage/file/file_layout.h"

/// Raw bytes of a page <-> stored bytes. The only place that knows LZ4.
namespace planetree::storage {

/// Most raw bytes a page may have; larger ones are refused before anything is allocated.
inline constexpr std::size_t kMaxRawBytes = 4 * std::size_t{kMaxPageBytes};

struct StoredPage {
  Codec codec;
  std::vector<std::byte> bytes;
};

/// Stores a page: as an LZ4 block, or as it is where LZ4 does not shrink it.
///
/// raw      1 to kMaxRawBytes bytes.
/// return   a function of `raw` alone, for one release of LZ4: no thread, memory or history counts.
/// threads  any number at once.
[[nodiscard]] StoredPage encode_page(std::span<const std::byte> raw);

/// Whether stored bytes of these lengths may exist: a raw page is stored at its own length, an
/// LZ4 block is shorter than its page and at most 255 times so. Nothing is allocated for a page
/// that fails this, so that no file can be a decompression bomb.
[[nodiscard]] bool lengths_are_plausible(Codec codec, std::uint64_t stored_bytes,
                                         std::uint64_t raw_bytes) noexcept;

/// Restores a page's raw bytes.
///
/// stored   any bytes, also hostile ones.
/// raw_out  exactly as long as the page; overwritten, also on failure. No overlap with `stored`.
/// errors   kDamaged: not the bytes of a page of this length, or an unknown codec.
/// threads  any number at once; no allocation.
Result<void> decode_page(Codec codec, std::span<const std::byte> stored,
                         std::span<std::byte> raw_out) noexcept;

}  // namespace planetree::storage
