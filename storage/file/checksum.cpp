#include "storage/file/checksum.h"

// Makes the layout of XXH3_state_t public: Hasher contains one.
#define XXH_STATIC_LINKING_ONLY
#include <xxhash.h>

#include <new>

namespace planetree::storage {

std::uint64_t hash64(std::span<const std::byte> bytes, std::uint64_t seed) noexcept {
  return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

Hash128 hash128(std::span<const std::byte> bytes) noexcept {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.low64, hash.high64};
}

Hasher::Hasher() noexcept {
  static_assert(sizeof(XXH3_state_t) <= kStateBytes);
  static_assert(alignof(XXH3_state_t) <= kStateAlignment);
  // The reset reads the seed field to decide whether a custom secret must be rebuilt, so the state
  // is zeroed first.
  XXH3_128bits_reset(new (state_) XXH3_state_t{});
}

void Hasher::add(std::span<const std::byte> bytes) noexcept {
  XXH3_128bits_update(std::launder(reinterpret_cast<XXH3_state_t*>(state_)), bytes.data(),
                      bytes.size());
}

Hash128 Hasher::value() const noexcept {
  const XXH128_hash_t hash =
      XXH3_128bits_digest(std::launder(reinterpret_cast<const XXH3_state_t*>(state_)));
  return {hash.low64, hash.high64};
}

std::uint64_t Hasher::value64() const noexcept {
  return XXH3_64bits_digest(std::launder(reinterpret_cast<const XXH3_state_t*>(state_)));
}

std::uint64_t header_hash(const FileHeader& header) noexcept {
  return hash64(std::as_bytes(std::span(&header, 1)).first(offsetof(FileHeader, header_hash)));
}

}  // namespace planetree::storage
