#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "planetree/error.h"
#include "storage/file/file_layout.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// An open .ptree file: page number -> verified raw bytes.
///
/// Everything outside the pages is checked at open and copied; each page is
/// checked whenever it is read. The file stays the one that was opened: if
/// another is renamed over its name, the old one is served on.
class PageFile {
 public:
  PageFile(PageFile&&) noexcept = default;
  PageFile& operator=(PageFile&&) noexcept = default;

  /// path    a regular file, or a link to one.
  /// calls   the system; must outlive the PageFile.
  /// errors  kNotFound, kPermission, kNoMemory, kReadFailed; kNotPlanetree, kUnsupported,
  ///         kTruncated, kDamaged. Memory claimed is bounded by the file's length.
  static Result<PageFile> open(const std::filesystem::path& path,
                               FileCalls& calls = FileCalls::real());

  const FileHeader& header() const noexcept { return header_; }
  std::uint32_t page_count() const noexcept { return header_.page_count; }
  std::span<const PageEntry> entries() const noexcept {
    return {entries_.get(), header_.page_count};
  }

  /// Bytes of memory the page table takes.
  std::uint64_t table_memory_bytes() const noexcept { return entries().size_bytes(); }

  /// Whether one of the file's two headers is damaged. Pages are served from
  /// the other; the file should be copied or built again before that goes too.
  bool header_copy_damaged() const noexcept { return header_copy_damaged_; }

  /// Reads, verifies and decodes one page.
  ///
  /// page            below page_count().
  /// stored_scratch  at least header().max_stored_bytes; its content is lost.
  /// raw_out         exactly entries()[page].raw_bytes; unspecified on failure.
  /// errors          with page and offset: kBadArgument; kReadFailed; kTruncated, if the file was
  ///                 cut short since; kDamaged.
  /// threads         any number at once; no lock, no allocation.
  Result<void> read_page(std::uint32_t page, std::span<std::byte> stored_scratch,
                         std::span<std::byte> raw_out) const noexcept;

  /// The same of a page that the system has in memory, or that a device gives as soon as `terms`
  /// want it. False where that takes longer, or reading fails in a way that read_page() tells.
  Result<bool> read_page_soon(std::uint32_t page, std::span<std::byte> stored_scratch,
                              std::span<std::byte> raw_out,
                              const SoonTerms& terms = {}) const noexcept;

 private:
  PageFile() noexcept = default;
  Result<void> load_header(std::uint64_t actual_bytes) noexcept;
  Result<void> load_table() noexcept;
  Result<void> check_buffers(std::uint32_t page, std::span<std::byte> stored_scratch,
                             std::span<std::byte> raw_out) const noexcept;
  Result<void> unpack(std::uint32_t page, std::span<const std::byte> stored,
                      std::span<std::byte> raw_out) const noexcept;

  FileHandle file_;
  FileHeader header_{};
  std::unique_ptr<PageEntry[]> entries_;
  bool header_copy_damaged_ = false;
};

}  // namespace planetree::storage
