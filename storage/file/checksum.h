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
///   page hash    of a page's stored bytes, seeded with its number: swapped pages fail
///   content id   of all page hashes: identifies the content of the file
///   page check   page hash exclusive-or the content id's low word: pages of other files fail
///   table hash   of the page table
///   header hash  of the header, which holds the content id and the table hash
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

/// XXH3-128 of bytes that are added in parts. The value does not depend on how they are split.
/// Contains its state, so that hashing a page table allocates nothing.
class Hasher128 {
 public:
  Hasher128() noexcept;

  void add(std::span<const std::byte> bytes) noexcept;
  [[nodiscard]] Hash128 value() const noexcept;

 private:
  static constexpr std::size_t kStateBytes = 576;
  static constexpr std::size_t kStateAlignment = 64;

  alignas(kStateAlignment) std::byte state_[kStateBytes];
};

/// page    page number.
/// stored  stored bytes of the page.
[[nodiscard]] std::uint64_t page_hash(std::uint32_t page,
                                      std::span<const std::byte> stored) noexcept;

/// Content id of pages whose `check` fields hold the page hashes exclusive-or `mask`.
[[nodiscard]] Hash128 content_id(std::span<const PageEntry> entries, std::uint64_t mask) noexcept;

[[nodiscard]] std::uint64_t table_hash(std::span<const PageEntry> entries) noexcept;

[[nodiscard]] std::uint64_t header_hash(const FileHeader& header) noexcept;

}  // namespace planetree::storage
