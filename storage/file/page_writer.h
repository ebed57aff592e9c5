#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "planetree/error.h"
#include "storage/file/file_layout.h"
#include "storage/file/page_codec.h"
#include "storage/system/file_calls.h"
#include "storage/system/new_file.h"

namespace planetree::storage {

/// Writes one .ptree file, page after page, and commits it whole or not at all.
///
/// The bytes written are a function of the arguments alone. An error is final:
/// every later call returns it, and destroying the writer leaves the
/// destination as it was.
/// threads  one at a time.
class PageWriter {
 public:
  PageWriter(PageWriter&&) noexcept = default;

  /// path        where the file shall appear.
  /// page_count  at least 1: the room for the page table is set aside by it.
  /// replace     whether an existing file may be replaced.
  /// calls       the system; must outlive the writer.
  /// errors      kBadArgument; kAlreadyExists; kPermission, kNoSpace and the like.
  /// memory      1 MiB and 40 bytes a page, until destroyed.
  static Result<PageWriter> create(const std::filesystem::path& path, std::uint32_t page_count,
                                   bool replace, FileCalls& calls = FileCalls::real());

  /// Adds the next page.
  ///
  /// octcode, ordinal  its key, above that of the page before it of its kind.
  /// raw_bytes         its length before encode_page().
  /// errors            kBadArgument: out of order, too many, or lengths no page can have;
  ///                   kNoSpace, kWriteFailed and the like.
  Result<void> append(std::uint64_t octcode, std::uint32_t ordinal, std::uint32_t raw_bytes,
                      const StoredPage& stored);

  /// The pages that follow are the mask's: their keys begin anew.
  void begin_mask() noexcept { first_mask_page_ = static_cast<std::uint32_t>(entries_.size()); }

  /// Completes the file, after page_count pages, and gives it its name.
  ///
  /// page_bytes  of a decoded page; a power of two from kMinPageBytes to kMaxPageBytes.
  /// return      the header as it was written.
  /// errors      kBadArgument: pages are missing or `model` breaks a rule of the format;
  ///             kAlreadyExists: the name was taken meanwhile; else as append(). See
  ///             NewFile::commit() for what a failure leaves.
  Result<FileHeader> finish(const ModelRecord& model, std::uint32_t page_bytes);

 private:
  explicit PageWriter(NewFile file) noexcept : file_(std::move(file)) {}
  Result<void> check_next(std::uint64_t octcode, std::uint32_t ordinal, std::uint32_t raw_bytes,
                          const StoredPage& stored) const noexcept;
  Result<void> add_bytes(std::span<const std::byte> bytes);
  Result<void> flush();
  FileHeader make_header(const ModelRecord& model, std::uint32_t page_bytes);
  Result<void> write_out(const FileHeader& header);
  Error fail(const Error& error) noexcept;

  NewFile file_;
  std::vector<PageEntry>
      entries_;  // `check` holds the bare page hash until the content id is known
  std::uint32_t page_count_ = 0;
  std::optional<std::uint32_t> first_mask_page_;
  std::vector<std::byte> buffer_;
  std::uint64_t buffer_offset_ = 0;  // in the file, of the buffer's first byte
  std::optional<Error> failure_;     // also set when finished
};

}  // namespace planetree::storage
