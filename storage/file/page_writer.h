#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "planetree/error.h"
#include "storage/file/extension.h"
#include "storage/file/file_layout.h"
#include "storage/file/model_output.h"
#include "storage/file/page_codec.h"
#include "storage/system/file_calls.h"

namespace planetree::storage {

/// Writes one model, page after page, and commits it either complete or not at all.
///
/// The bytes written depend on the arguments alone. After an error every later call returns that
/// error, and destroying the writer leaves the destination unchanged.
/// threads  one at a time.
class PageWriter {
 public:
  PageWriter(PageWriter&&) noexcept = default;

  /// Starts a file.
  ///
  /// path        destination of the file.
  /// page_count  number of pages, at least 1; determines the length of the directory.
  /// extensions  at most kMaxExtensions, with different names; in any order.
  /// replace     whether an existing file may be replaced.
  /// calls       the system; must outlive the writer.
  /// errors      kBadArgument; kAlreadyExists; those of file_error(), such as kPermission and
  ///             kNoSpace.
  /// memory      1 MiB, 24 bytes per page and the extensions, until the writer is destroyed.
  static Result<PageWriter> create(const std::filesystem::path& path, std::uint32_t page_count,
                                   std::vector<Extension> extensions, bool replace,
                                   FileCalls& calls = FileCalls::real());
  /// Starts the writing of a model to `output`; otherwise as above.
  ///
  /// errors  kBadArgument; those of `output`.
  static Result<PageWriter> create(std::unique_ptr<ModelOutput> output, std::uint32_t page_count,
                                   std::vector<Extension> extensions);

  /// Adds the next page.
  ///
  /// octcode    of the page, not below that of the previous page of its kind.
  /// raw_bytes  length of the page before compress_page().
  /// stored     result of compress_page().
  /// errors     kBadArgument: out of order, too many pages, or lengths that no page can have; those
  ///            of file_error(), such as kNoSpace and kWriteFailed.
  Result<void> append(std::uint64_t octcode, std::uint32_t raw_bytes, const StoredPage& stored);

  /// Marks the pages appended from now on as cap pages, field pages, attribute pages or mask pages,
  /// with an order of keys of their own. Call those that are called in this order.
  void begin_caps() noexcept { first_cap_page_ = static_cast<std::uint32_t>(entries_.size()); }
  void begin_field() noexcept { first_field_page_ = static_cast<std::uint32_t>(entries_.size()); }
  void begin_attributes() noexcept {
    first_attribute_page_ = static_cast<std::uint32_t>(entries_.size());
  }
  void begin_mask() noexcept { first_mask_page_ = static_cast<std::uint32_t>(entries_.size()); }

  /// Completes the file, after page_count pages, and commits it. Call it once.
  ///
  /// page_bytes  size of a decoded page: a power of two from kMinPageBytes to kMaxPageBytes.
  /// return      the header that was written.
  /// errors      kBadArgument: pages are missing or `model` breaks a rule of the format;
  ///             kAlreadyExists: the name was taken in the meantime; otherwise those of append().
  ///             ModelOutput::commit() states what remains after a failure.
  Result<FileHeader> finish(const ModelRecord& model, std::uint32_t page_bytes);

 private:
  explicit PageWriter(std::unique_ptr<ModelOutput> output) noexcept : output_(std::move(output)) {}
  Result<void> check_next(std::uint64_t octcode, std::uint32_t raw_bytes,
                          const StoredPage& stored) const noexcept;
  Result<void> add_bytes(std::span<const std::byte> bytes);
  Result<void> flush();
  Result<void> write_extensions();
  FileHeader make_header(const ModelRecord& model, std::uint32_t page_bytes) const;
  Result<void> write_out(FileHeader& header);
  Error fail(const Error& error) noexcept;

  std::unique_ptr<ModelOutput> output_;
  std::vector<DirectoryPage> entries_;
  std::vector<Extension> extensions_;
  std::vector<ExtensionRecord> extension_records_;
  std::uint32_t page_count_ = 0;
  std::optional<std::uint32_t> first_cap_page_, first_field_page_, first_attribute_page_,
      first_mask_page_;
  std::vector<std::byte> buffer_;
  std::uint64_t buffer_offset_ = 0;  // file offset of the buffer's first byte
  std::optional<Error> failure_;     // first error; also set by a successful finish()
};

}  // namespace planetree::storage
