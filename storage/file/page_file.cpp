#include "storage/file/page_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <new>
#include <utility>

#include "storage/file/checksum.h"
#include "storage/file/header_check.h"
#include "storage/file/header_choice.h"
#include "storage/file/page_codec.h"
#include "storage/system/file_error.h"
#include "storage/system/mapping.h"

namespace planetree::storage {
namespace {

Result<std::uint64_t> length_of(const FileHandle& file) noexcept {
  struct stat status;
  if (file.calls().fstat(file.descriptor(), &status) != 0) {
    return file_error(errno, FileAction::kRead, "examine the file");
  }
  if (!S_ISREG(status.st_mode)) {
    return make_error(ErrorCode::kNotPlanetree, Error::kNowhere, Error::kNowhere,
                      "this is not a .ptree file but a %s; name a regular file",
                      S_ISDIR(status.st_mode) ? "directory" : "device, pipe or socket");
  }
  return static_cast<std::uint64_t>(status.st_size);
}

Error located(Error error, std::uint32_t page, std::uint64_t offset) noexcept {
  error.page = page;
  error.offset = offset;
  return error;
}

}  // namespace

Result<PageFile> PageFile::open(const std::filesystem::path& path, FileCalls& calls) {
  PageFile opened;
  // O_NONBLOCK: opening a pipe without a writer must not block.
  opened.file_ = FileHandle::open(calls, AT_FDCWD, path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY);
  if (!opened.file_.is_open()) return file_error(errno, FileAction::kRead, "open the file");
  const Result<std::uint64_t> actual_bytes = length_of(opened.file_);
  if (!actual_bytes) return actual_bytes.error();
  if (const Result<void> loaded = opened.load_header(*actual_bytes); !loaded) {
    return loaded.error();
  }
  if (const Result<void> loaded = opened.load_table(); !loaded) return loaded.error();
  return opened;
}

Result<void> PageFile::load_header(std::uint64_t actual_bytes) noexcept {
  std::byte leading[kHeaderBytes];
  std::byte trailing[kHeaderBytes];
  const std::size_t leading_bytes =
      static_cast<std::size_t>(std::min<std::uint64_t>(actual_bytes, kHeaderBytes));
  const std::size_t trailing_bytes = actual_bytes >= 2 * kHeaderBytes ? kHeaderBytes : 0;
  const std::span<std::byte> first = std::span(leading).first(leading_bytes);
  const std::span<std::byte> last = std::span(trailing).first(trailing_bytes);
  if (const Result<void> read = copy_mapped(file_, 0, first); !read) return read;
  if (const Result<void> read = copy_mapped(file_, actual_bytes - trailing_bytes, last); !read) {
    return read;
  }
  const Result<HeaderChoice> choice = choose_header(first, last, actual_bytes);
  if (!choice) return choice.error();
  header_ = choice->header;
  header_copy_damaged_ = choice->copy_damaged;
  return check_header(header_, actual_bytes);
}

Result<void> PageFile::load_table() noexcept {
  entries_.reset(new (std::nothrow) PageEntry[header_.page_count]);
  const std::size_t table_bytes = header_.page_count * sizeof(PageEntry);
  if (entries_ == nullptr) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, kHeaderBytes,
                      "no memory for the page table of %zu bytes; free some memory", table_bytes);
  }
  const std::span<PageEntry> table(entries_.get(), header_.page_count);
  if (const Result<void> read = copy_mapped(file_, kHeaderBytes, std::as_writable_bytes(table));
      !read) {
    return read;
  }
  return check_table(header_, table);
}

Result<void> PageFile::check_buffers(std::uint32_t page, std::span<std::byte> stored_scratch,
                                     std::span<std::byte> raw_out) const noexcept {
  if (page >= page_count()) {
    return make_error(ErrorCode::kBadArgument, page, Error::kNowhere,
                      "the file has no such page; its last is %" PRIu32, page_count() - 1);
  }
  const PageEntry& entry = entries_[page];
  if (stored_scratch.size() < header_.max_stored_bytes || raw_out.size() != entry.raw_bytes) {
    return make_error(ErrorCode::kBadArgument, page, entry.offset,
                      "the buffers given have %zu and %zu bytes; they need at least %" PRIu64
                      " and exactly %" PRIu32,
                      stored_scratch.size(), raw_out.size(), header_.max_stored_bytes,
                      entry.raw_bytes);
  }
  return {};
}

Result<void> PageFile::read_page(std::uint32_t page, std::span<std::byte> stored_scratch,
                                 std::span<std::byte> raw_out) const noexcept {
  if (const Result<void> checked = check_buffers(page, stored_scratch, raw_out); !checked) {
    return checked;
  }
  const PageEntry& entry = entries_[page];
  const std::span<std::byte> stored = stored_scratch.first(entry.stored_bytes);
  if (const Result<void> read = file_.read_at(entry.offset, stored); !read) {
    return located(read.error(), page, entry.offset);
  }
  return unpack(page, stored, raw_out);
}

Result<bool> PageFile::try_read_page(std::uint32_t page, std::span<std::byte> stored_scratch,
                                     std::span<std::byte> raw_out,
                                     const ReadLimits& terms) const noexcept {
  if (const Result<void> checked = check_buffers(page, stored_scratch, raw_out); !checked) {
    return checked.error();
  }
  const PageEntry& entry = entries_[page];
  const std::span<std::byte> stored = stored_scratch.first(entry.stored_bytes);
  if (!file_.try_read(entry.offset, stored, terms)) return false;
  if (const Result<void> unpacked = unpack(page, stored, raw_out); !unpacked) {
    return unpacked.error();
  }
  return true;
}

Result<void> PageFile::unpack(std::uint32_t page, std::span<const std::byte> stored,
                              std::span<std::byte> raw_out) const noexcept {
  const PageEntry& entry = entries_[page];
  if ((page_hash(page, stored) ^ header_.content_id[0]) != entry.check) {
    return make_error(
        ErrorCode::kDamaged, page, entry.offset,
        "the page's checksum is wrong; restore the file from a copy or build it again");
  }
  if (const Result<void> decoded = decompress_page(entry.codec, stored, raw_out); !decoded) {
    return located(decoded.error(), page, entry.offset);
  }
  return {};
}

}  // namespace planetree::storage
