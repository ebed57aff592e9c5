#include "storage/file/checksum.h"

// The state's layout is public only under this name; Hasher128 holds one in place.
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

Hasher128::Hasher128() noexcept {
  static_assert(sizeof(XXH3_state_t) <= kStateBytes);
  static_assert(alignof(XXH3_state_t) <= kStateAlignment);
  // xxHash reads the seed's field to see whether a custom secret must be rebuilt, so the state
  // starts from zero rather than from whatever was on the stack.
  XXH3_128bits_reset(new (state_) XXH3_state_t{});
}

void Hasher128::add(std::span<const std::byte> bytes) noexcept {
  XXH3_128bits_update(std::launder(reinterpret_cast<XXH3_state_t*>(state_)), bytes.data(),
                      bytes.size());
}

Hash128 Hasher128::value() const noexcept {
  const XXH128_hash_t hash =
      XXH3_128bits_digest(std::launder(reinterpret_cast<const XXH3_state_t*>(state_)));
  return {hash.low64, hash.high64};
}

}  // namespace planetree::storage
