#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "storage/file/file_layout.h"

/// XXH3 hashes. No other file of the library uses xxHash.
///
/// The values are stored in files, so they must be the published XXH3 values (final since
/// xxHash 0.8.0). The tests compare them with known answers.
///
/// Hashes of a .ptree file, shared by writer and reader.
///
///   page check       of a page's stored bytes, in the directory
///   block check      of a block of the directory, in the block above it
///   content id       of the directory's root, so of all pages: identifies the content of the file
///   extensions hash  of the extension records, which have the hashes of the extensions
///   header hash      of the header, which has the content id and the extensions hash
namespace planetree::storage {

struct Hash128 {
  std::uint64_t low;
  std::uint64_t high;

  friend bool operator==(const Hash128&, const Hash128&) = default;
};

/// XXH3-64 of `bytes`, which may be empty.
[[nodiscard]] std::uint64_t hash64(std::span<const std::byte> bytes,
                                   std::uint64_t seed = 0) noexcept;

/// XXH3-128 of `bytes`, which may be empty, with seed 0.
[[nodiscard]] Hash128 hash128(std::span<const std::byte> bytes) noexcept;

/// XXH3 of bytes that are added in parts. The values do not depend on how they are split. Contains
/// its state, so that hashing allocates nothing.
class Hasher {
 public:
  Hasher() noexcept;

  void add(std::span<const std::byte> bytes) noexcept;
  [[nodiscard]] Hash128 value() const noexcept;          ///< XXH3-128
  [[nodiscard]] std::uint64_t value64() const noexcept;  ///< XXH3-64

 private:
  static constexpr std::size_t kStateBytes = 576;
  static constexpr std::size_t kStateAlignment = 64;

  alignas(kStateAlignment) std::byte state_[kStateBytes];
};

[[nodiscard]] std::uint64_t header_hash(const FileHeader& header) noexcept;

}  // namespace planetree::storage
