#include "storage/file/file_hash.h"

namespace planetree::storage {

std::uint64_t page_hash(std::uint32_t page, std::span<const std::byte> stored) noexcept {
  return hash64(stored, page);
}

Hash128 content_id(std::span<const PageEntry> entries, std::uint64_t mask) noexcept {
  Hasher128 hasher;
  for (const PageEntry& entry : entries) {
    const std::uint64_t hash = entry.check ^ mask;
    hasher.add(std::as_bytes(std::span(&hash, 1)));
  }
  return hasher.value();
}

std::uint64_t table_hash(std::span<const PageEntry> entries) noexcept {
  return hash64(std::as_bytes(entries));
}

std::uint64_t header_hash(const FileHeader& header) noexcept {
  return hash64(std::as_bytes(std::span(&header, 1)).first(offsetof(FileHeader, header_hash)));
}

}  // namespace planetree::storage
