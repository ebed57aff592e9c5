#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "planetree/error.h"
#include "storage/file/directory.h"
#include "storage/file/file_layout.h"
#include "storage/system/byte_source.h"
#include "storage/system/file_calls.h"

namespace planetree::storage {

/// An open .ptree file: returns the verified raw bytes of its pages.
///
/// The header and the records of extensions are copied and checked at open, and the directory
/// unless it is greater than what Directory keeps. Each page is checked whenever it is read. If
/// another file is renamed to the same path, the object goes on reading the file that it opened.
class PageFile {
 public:
  PageFile(PageFile&&) noexcept = default;
  PageFile& operator=(PageFile&&) noexcept = default;

  /// Opens a file. Allocates no more memory than the file is long.
  ///
  /// path    a regular file, or a link to one.
  /// calls   the system; must outlive the PageFile.
  /// errors  kNotFound, kPermission, kNoMemory, kReadFailed; kNotPlanetree, kUnsupported,
  ///         kTruncated, kDamaged.
  static Result<PageFile> open(const std::filesystem::path& path,
                               FileCalls& calls = FileCalls::real());
  /// Opens a file whose bytes a source has. The trailing header of a remote one is read only if the
  /// leading one is damaged.
  ///
  /// errors  those of reading the source; kNoMemory; kNotPlanetree, kUnsupported, kTruncated,
  ///         kDamaged.
  static Result<PageFile> open(std::unique_ptr<ByteSource> source);

  const ByteSource& source() const noexcept { return *source_; }

  const FileHeader& header() const noexcept { return header_; }
  std::uint32_t page_count() const noexcept { return header_.page_count; }
  std::span<const ExtensionRecord> extensions() const noexcept { return extensions_; }

  /// Returns where a page is, and its lengths. May read a block of the directory.
  ///
  /// errors   kBadArgument: there is no such page; kReadFailed; kTruncated; kDamaged.
  /// threads  any number at once; no allocation; see Directory.
  Result<PageEntry> entry(std::uint32_t page) const noexcept;
  /// Returns the same if that reads nothing from the file.
  std::optional<PageEntry> kept_entry(std::uint32_t page) const noexcept;

  /// Bytes of memory that the directory takes.
  std::uint64_t directory_memory_bytes() const noexcept { return directory_->memory_bytes(); }
  /// Bytes of memory that the directory and the source take.
  std::uint64_t memory_bytes() const noexcept {
    return directory_memory_bytes() + source_->memory_bytes();
  }

  /// Reads and verifies the bytes of an extension.
  ///
  /// record  one of extensions().
  /// errors  kNoMemory; kReadFailed; kTruncated; kDamaged.
  Result<std::vector<std::byte>> read_extension(const ExtensionRecord& record) const;

  /// Whether one of the file's two headers is damaged. The other one is used; the file should be
  /// copied or built again before that one is damaged too.
  bool header_copy_damaged() const noexcept { return header_copy_damaged_; }

  /// Reads, verifies and decodes one page.
  ///
  /// page            below page_count().
  /// stored_scratch  at least header().max_stored_bytes bytes; overwritten.
  /// raw_out         exactly entry(page)->raw_bytes bytes; unspecified on failure.
  /// errors          with page and offset: kBadArgument; kReadFailed; kTruncated: the file became
  ///                 shorter after it was opened; kDamaged.
  /// threads         any number at once; no allocation; see Directory.
  Result<void> read_page(std::uint32_t page, std::span<std::byte> stored_scratch,
                         std::span<std::byte> raw_out) const noexcept;

  /// Does the same within the time limits of `terms`. Returns false if the read would block, also
  /// for a block of the directory, or fails. In both cases read_page() reads the page or returns
  /// the error. errors  kBadArgument, kDamaged.
  Result<bool> try_read_page(std::uint32_t page, std::span<std::byte> stored_scratch,
                             std::span<std::byte> raw_out,
                             const ReadLimits& terms = {}) const noexcept;

  /// Lets the source of a remote file get pages that are read soon, many at once. Does nothing for
  /// a file of this machine, and for pages that do not exist.
  void prefetch(std::span<const std::uint32_t> pages) const noexcept;
  /// Does the same for at most `max_time`.
  void prefetch_within(std::span<const std::uint32_t> pages,
                       std::chrono::milliseconds max_time) const noexcept;

  /// Whether read_page() takes no request to another machine.
  bool is_here(std::uint32_t page) const noexcept;

 private:
  PageFile() noexcept = default;
  Result<void> load_header() noexcept;
  Result<void> load_extensions();
  Result<void> load_directory() noexcept;
  void prefetch_blocks(std::span<const std::uint32_t> pages,
                       std::chrono::steady_clock::time_point end) const noexcept;
  void prefetch_pages(std::span<const std::uint32_t> pages,
                      std::chrono::steady_clock::time_point end) const noexcept;
  Result<void> check_page(std::uint32_t page) const noexcept;
  Result<void> check_buffers(std::uint32_t page, const PageEntry& entry,
                             std::span<std::byte> stored_scratch,
                             std::span<std::byte> raw_out) const noexcept;

  std::unique_ptr<ByteSource> source_;
  FileHeader header_{};
  std::vector<ExtensionRecord> extensions_;
  std::optional<Directory> directory_;
  bool header_copy_damaged_ = false;
};

}  // namespace planetree::storage
