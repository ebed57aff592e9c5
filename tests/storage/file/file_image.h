#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <utility>
#include <vector>

#include "storage/file/checksum.h"
#include "storage/file/directory_shape.h"
#include "storage/file/directory_writer.h"
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

  /// Entry of a page in the directory.
  DirectoryPage entry(std::uint32_t page) const {
    return get<DirectoryPage>(offset_of_entry(page));
  }
  void set_entry(std::uint32_t page, const DirectoryPage& entry) {
    set(offset_of_entry(page), entry);
  }
  std::size_t offset_of_entry(std::uint32_t page) const {
    const DirectoryShape shape(header().page_count);
    return directory_block_start(header(), shape, shape.page_level(), 0) +
           page * sizeof(DirectoryPage);
  }
  /// Offset in the file of a page's stored bytes, as the entries say.
  std::size_t offset_of_page(std::uint32_t page) const {
    std::size_t offset = pages_start(header());
    for (std::uint32_t before = 0; before < page; ++before) offset += entry(before).stored_bytes;
    return offset;
  }
  ExtensionRecord extension(std::uint32_t index) const {
    return get<ExtensionRecord>(kHeaderBytes + index * sizeof(ExtensionRecord));
  }
  void set_extension(std::uint32_t index, const ExtensionRecord& record) {
    set(kHeaderBytes + index * sizeof(ExtensionRecord), record);
  }

  template <class Change>
  void change_header(Change change) {
    FileHeader changed = header();
    change(changed);
    set_header(changed);
  }
  template <class Change>
  void change_entry(std::uint32_t page, Change change) {
    DirectoryPage changed = entry(page);
    change(changed);
    set_entry(page, changed);
  }

  std::span<std::byte> stored(std::uint32_t page) {
    return std::span(bytes_).subspan(offset_of_page(page), entry(page).stored_bytes);
  }

  /// Whether the directory that the header describes lies within the bytes.
  bool directory_fits() const {
    return bytes_.size() >= kHeaderBytes && header().page_count > 0 &&
           header().extension_count <= kMaxExtensions && pages_start(header()) <= bytes_.size();
  }

  /// Computes the hashes of pages from the stored bytes. Pages that lie outside the file get a hash
  /// of 0.
  void seal_pages() {
    std::size_t offset = pages_start(header());
    for (std::uint32_t page = 0; page < header().page_count; ++page) {
      const std::size_t stored_bytes = entry(page).stored_bytes;
      const bool inside = offset <= bytes_.size() && stored_bytes <= bytes_.size() - offset;
      const std::uint64_t check =
          inside ? hash64(std::span(bytes_).subspan(offset, stored_bytes)) : 0;
      change_entry(page, [&](DirectoryPage& it) { it.check = check; });
      offset += stored_bytes;
    }
  }

  /// Makes the upper levels of the directory and the content id from the entries of pages.
  void seal_directory() {
    FileHeader sealed = header();
    std::vector<DirectoryPage> pages(sealed.page_count);
    for (std::uint32_t page = 0; page < pages.size(); ++page) pages[page] = entry(page);
    const DirectoryWriter directory(sealed, pages);
    for (unsigned level = 0; level < directory.shape().levels(); ++level) {
      const std::size_t offset = directory_block_start(sealed, directory.shape(), level, 0);
      std::ranges::copy(directory.level(level),
                        bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
    }
    sealed.content_id[0] = directory.content_id().low;
    sealed.content_id[1] = directory.content_id().high;
    set_header(sealed);
  }

  void seal_extensions() {
    FileHeader sealed = header();
    sealed.extensions_hash = hash64(
        std::span(bytes_).subspan(kHeaderBytes, sealed.extension_count * sizeof(ExtensionRecord)));
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
    seal_directory();
    seal_extensions();
    seal_header();
  }

 private:
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
