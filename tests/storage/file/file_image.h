#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <utility>
#include <vector>

#include "storage/file/checksum.h"
#include "storage/file/file_layout.h"
#include "storage/file/header_check.h"

namespace planetree::storage {

using Bytes = std::vector<std::byte>;

inline Bytes read_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  Bytes bytes(std::filesystem::file_size(path));
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

inline void write_bytes(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}

/// The bytes of a .ptree file, to be changed and then given matching hashes, so that a reader
/// refuses the change and not the hash.
class FileImage {
 public:
  explicit FileImage(Bytes bytes) : bytes_(std::move(bytes)) {}

  Bytes& bytes() { return bytes_; }

  FileHeader header() const { return get<FileHeader>(0); }
  /// Changes the leading header only.
  void set_header(const FileHeader& header) { set(0, header); }

  PageEntry entry(std::uint32_t page) const { return get<PageEntry>(table_end(page)); }
  void set_entry(std::uint32_t page, const PageEntry& entry) { set(table_end(page), entry); }

  template <class Change>
  void change_header(Change change) {
    FileHeader changed = header();
    change(changed);
    set_header(changed);
  }
  template <class Change>
  void change_entry(std::uint32_t page, Change change) {
    PageEntry changed = entry(page);
    change(changed);
    set_entry(page, changed);
  }

  std::span<std::byte> stored(std::uint32_t page) {
    return std::span(bytes_).subspan(entry(page).offset, entry(page).stored_bytes);
  }

  /// Whether the page table that the header describes lies within the bytes.
  bool table_fits() const {
    return bytes_.size() >= kHeaderBytes && table_end(header().page_count) <= bytes_.size();
  }

  /// Computes page checks and content id from the stored bytes. Pages that lie outside the file get
  /// a hash of 0.
  void seal_pages() {
    std::vector<PageEntry> entries = all_entries();
    FileHeader sealed = header();
    for (std::uint32_t page = 0; page < sealed.page_count; ++page) {
      PageEntry& entry = entries[page];
      const bool inside =
          entry.offset <= bytes_.size() && entry.stored_bytes <= bytes_.size() - entry.offset;
      entry.check = inside ? page_hash(page, stored(page)) : 0;
    }
    const Hash128 id = content_id(entries, 0);
    for (std::uint32_t page = 0; page < sealed.page_count; ++page) {
      entries[page].check ^= id.low;
      set_entry(page, entries[page]);
    }
    sealed.content_id[0] = id.low;
    sealed.content_id[1] = id.high;
    set_header(sealed);
  }

  void seal_table() {
    FileHeader sealed = header();
    sealed.table_hash = table_hash(all_entries());
    set_header(sealed);
  }

  /// Computes the header's own hash, and writes the copy at the end if the file is long enough.
  void seal_header() {
    FileHeader sealed = header();
    sealed.header_hash = header_hash(sealed);
    set_header(sealed);
    if (bytes_.size() >= 2 * kHeaderBytes) set(bytes_.size() - kHeaderBytes, sealed);
  }

  void seal() {
    seal_pages();
    seal_table();
    seal_header();
  }

 private:
  std::vector<PageEntry> all_entries() const {
    std::vector<PageEntry> entries(header().page_count);
    for (std::uint32_t page = 0; page < entries.size(); ++page) entries[page] = entry(page);
    return entries;
  }

  template <class T>
  T get(std::size_t offset) const {
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }
  template <class T>
  void set(std::size_t offset, const T& value) {
    std::memcpy(bytes_.data() + offset, &value, sizeof value);
  }

  Bytes bytes_;
};

}  // namespace planetree::storage
