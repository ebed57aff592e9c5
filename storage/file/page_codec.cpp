#include "storage/file/page_codec.h"

#include <lz4.h>
#include <lz4hc.h>

#include <cassert>
#include <cstring>

namespace planetree::storage {
namespace {

constexpr int kCompressionLevel = 4;
// Maximum number of raw bytes for one byte of an LZ4 block.
constexpr std::uint64_t kMaxExpansion = 255;

Error damaged(const char* cause) noexcept {
  return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                    "%s; restore the file from a copy or build it again", cause);
}

// Returns an empty vector if LZ4 does not make the page shorter.
std::vector<std::byte> compress(std::span<const std::byte> raw) {
  if (raw.size() < 2) return {};
  // If LZ4 allocated its state, it would report a lack of memory like a page that does not become
  // shorter, and the file's bytes would depend on the machine. This allocation throws instead.
  std::vector<std::byte> state(static_cast<std::size_t>(LZ4_sizeofStateHC()));
  std::vector<std::byte> bytes(raw.size() - 1);
  const int length = LZ4_compress_HC_extStateHC(
      state.data(), reinterpret_cast<const char*>(raw.data()),
      reinterpret_cast<char*>(bytes.data()), static_cast<int>(raw.size()),
      static_cast<int>(bytes.size()), kCompressionLevel);
  bytes.resize(length > 0 ? static_cast<std::size_t>(length) : 0);
  return bytes;
}

}  // namespace

StoredPage compress_page(std::span<const std::byte> raw) {
  assert(!raw.empty() && raw.size() <= kMaxRawBytes);
  std::vector<std::byte> compressed = compress(raw);
  if (!compressed.empty()) {
    compressed.shrink_to_fit();
    return {Codec::kLz4, std::move(compressed)};
  }
  return {Codec::kStored, {raw.begin(), raw.end()}};
}

bool lengths_are_plausible(Codec codec, std::uint64_t stored_bytes,
                           std::uint64_t raw_bytes) noexcept {
  if (raw_bytes == 0 || raw_bytes > kMaxRawBytes) return false;
  switch (codec) {
    case Codec::kStored:
      return stored_bytes == raw_bytes;
    case Codec::kLz4:
      return stored_bytes < raw_bytes && stored_bytes * kMaxExpansion >= raw_bytes;
  }
  return false;
}

Result<void> decompress_page(Codec codec, std::span<const std::byte> stored,
                             std::span<std::byte> raw_out) noexcept {
  if (codec != Codec::kStored && codec != Codec::kLz4)
    return damaged("the page's codec is unknown");
  if (!lengths_are_plausible(codec, stored.size(), raw_out.size())) {
    return damaged("the page's stored length cannot give its raw length");
  }
  if (codec == Codec::kStored) {
    std::memcpy(raw_out.data(), stored.data(), stored.size());
    return {};
  }
  const int length = LZ4_decompress_safe(
      reinterpret_cast<const char*>(stored.data()), reinterpret_cast<char*>(raw_out.data()),
      static_cast<int>(stored.size()), static_cast<int>(raw_out.size()));
  if (length < 0) return damaged("the page is not an LZ4 block");
  if (static_cast<std::size_t>(length) != raw_out.size()) {
    return damaged("the page's LZ4 block ends before its raw length");
  }
  return {};
}

}  // namespace planetree::storage
