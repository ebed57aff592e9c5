#include "storage/file/page_file.h"

#include <algorithm>
#include <cinttypes>
#include <new>
#include <utility>

#include "storage/file/checksum.h"
#include "storage/file/extension.h"
#include "storage/file/header_check.h"
#include "storage/file/header_choice.h"
#include "storage/file/page_codec.h"

namespace planetree::storage {
namespace {

using Clock = std::chrono::steady_clock;

// Pages that are prefetched together.
constexpr std::size_t kMaxRanges = 64;
// Longer than any request takes.
constexpr std::chrono::milliseconds kLongTime = std::chrono::hours(1);

std::chrono::milliseconds time_until(Clock::time_point end) noexcept {
  return std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now());
}

Error located(Error error, std::uint32_t page, std::uint64_t offset) noexcept {
  error.page = page;
  error.offset = offset;
  return error;
}

// Verifies the stored bytes of a page and decodes them.
Result<void> unpack(std::uint32_t page, const PageEntry& entry, std::span<const std::byte> stored,
                    std::span<std::byte> raw_out) noexcept {
  if (hash64(stored) != entry.check) {
    return make_error(
        ErrorCode::kDamaged, page, entry.offset,
        "the page's checksum is wrong; restore the file from a copy or build it again");
  }
  if (const Result<void> decoded = decompress_page(entry.codec(), stored, raw_out); !decoded) {
    return located(decoded.error(), page, entry.offset);
  }
  return {};
}

}  // namespace

Result<PageFile> PageFile::open(const std::filesystem::path& path, FileCalls& calls) {
  auto source = open_file_source(path.c_str(), calls);
  if (!source) return source.error();
  return open(std::move(*source));
}

Result<PageFile> PageFile::open(std::unique_ptr<ByteSource> source) {
  PageFile opened;
  opened.source_ = std::move(source);
  if (const Result<void> loaded = opened.load_header(); !loaded) return loaded.error();
  if (const Result<void> loaded = opened.load_extensions(); !loaded) return loaded.error();
  if (const Result<void> loaded = opened.load_directory(); !loaded) return loaded.error();
  return opened;
}

Result<void> PageFile::load_header() noexcept {
  const std::uint64_t actual_bytes = source_->size_bytes();
  std::byte leading[kHeaderBytes];
  std::byte trailing[kHeaderBytes];
  const std::size_t leading_bytes =
      static_cast<std::size_t>(std::min<std::uint64_t>(actual_bytes, kHeaderBytes));
  const std::size_t trailing_bytes = actual_bytes >= 2 * kHeaderBytes ? kHeaderBytes : 0;
  const std::span<std::byte> first = std::span(leading).first(leading_bytes);
  const std::span<std::byte> last = std::span(trailing).first(trailing_bytes);
  if (const Result<void> read = source_->read_early(0, first); !read) return read;
  // The copy of a remote file takes a request of its own. It counts as equal to a whole header.
  const bool spares_copy =
      source_->is_remote() && !last.empty() && choose_header(first, {}, actual_bytes);
  if (spares_copy) {
    std::copy(first.begin(), first.end(), last.begin());
  } else if (const auto read = source_->read_early(actual_bytes - trailing_bytes, last); !read) {
    return read;
  }
  const Result<HeaderChoice> choice = choose_header(first, last, actual_bytes);
  if (!choice) return choice.error();
  header_ = choice->header;
  header_copy_damaged_ = choice->copy_damaged;
  return check_header(header_, actual_bytes);
}

Result<void> PageFile::load_extensions() {
  extensions_.resize(header_.extension_count);
  const std::span<std::byte> bytes = std::as_writable_bytes(std::span(extensions_));
  if (!bytes.empty()) {
    if (const Result<void> read = source_->read_early(kHeaderBytes, bytes); !read) return read;
  }
  return check_extensions(header_, extensions_);
}

Result<void> PageFile::load_directory() noexcept {
  // The directory, if it is read at once, and the root page behind it.
  const std::uint64_t end = pages_start(header_) + header_.max_stored_bytes;
  if (pages_start(header_) <= Directory::kMaxRemoteBytes) {
    const ByteRange range{0, std::min(end, source_->size_bytes())};
    source_->prefetch({&range, 1});
  }
  Result<Directory> opened = Directory::open(*source_, header_);
  if (!opened) return opened.error();
  directory_.emplace(*std::move(opened));
  return {};
}

Result<std::vector<std::byte>> PageFile::read_extension(const ExtensionRecord& record) const {
  std::vector<std::byte> bytes;
  try {
    bytes.resize(record.bytes);
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, record.offset,
                      "no memory for an extension of %" PRIu64 " bytes; free some memory",
                      record.bytes);
  }
  if (bytes.empty()) return bytes;
  if (const Result<void> read = source_->read_at(record.offset, bytes); !read) return read.error();
  if (hash64(bytes) != record.check) {
    return make_error(ErrorCode::kDamaged, Error::kNowhere, record.offset,
                      "the hash of an extension is wrong; restore the file from a copy or build it "
                      "again");
  }
  return bytes;
}

Result<void> PageFile::check_page(std::uint32_t page) const noexcept {
  if (page < page_count()) return {};
  return make_error(ErrorCode::kBadArgument, page, Error::kNowhere,
                    "the file has no such page; its last is %" PRIu32, page_count() - 1);
}

Result<PageEntry> PageFile::entry(std::uint32_t page) const noexcept {
  if (const Result<void> checked = check_page(page); !checked) return checked.error();
  return directory_->entry(*source_, header_, page);
}

std::optional<PageEntry> PageFile::kept_entry(std::uint32_t page) const noexcept {
  if (page >= page_count()) return {};
  return directory_->kept_entry(header_, page);
}

Result<void> PageFile::check_buffers(std::uint32_t page, const PageEntry& entry,
                                     std::span<std::byte> stored_scratch,
                                     std::span<std::byte> raw_out) const noexcept {
  if (stored_scratch.size() >= header_.max_stored_bytes && raw_out.size() == entry.raw_bytes)
    return {};
  return make_error(ErrorCode::kBadArgument, page, entry.offset,
                    "the buffers given have %zu and %zu bytes; they need at least %" PRIu32
                    " and exactly %" PRIu32,
                    stored_scratch.size(), raw_out.size(), header_.max_stored_bytes,
                    entry.raw_bytes);
}

Result<void> PageFile::read_page(std::uint32_t page, std::span<std::byte> stored_scratch,
                                 std::span<std::byte> raw_out) const noexcept {
  const Result<PageEntry> entry = this->entry(page);
  if (!entry) return entry.error();
  if (const auto checked = check_buffers(page, *entry, stored_scratch, raw_out); !checked)
    return checked;
  const std::span<std::byte> stored = stored_scratch.first(entry->stored_bytes);
  const auto read_once = [&]() -> Result<void> {
    if (const Result<void> read = source_->read_at(entry->offset, stored); !read)
      return located(read.error(), page, entry->offset);
    return unpack(page, *entry, stored, raw_out);
  };
  const Result<void> read = read_once();
  // What a cache keeps, or a connection delivered, may be wrong where the file is not.
  const bool is_wrong = !read && read.error().code == ErrorCode::kDamaged;
  if (is_wrong && source_->forget({entry->offset, entry->stored_bytes})) return read_once();
  return read;
}

void PageFile::prefetch(std::span<const std::uint32_t> pages) const noexcept {
  prefetch_within(pages, kLongTime);
}

void PageFile::prefetch_within(std::span<const std::uint32_t> pages,
                               std::chrono::milliseconds max_time) const noexcept {
  if (!source_->is_remote()) return;
  const Clock::time_point end = Clock::now() + std::min(max_time, kLongTime);
  while (!pages.empty()) {
    const auto some = pages.first(std::min(pages.size(), kMaxRanges));
    prefetch_blocks(some, end);
    prefetch_pages(some, end);
    pages = pages.subspan(some.size());
  }
}

// Gets the blocks of the directory that tell where pages are.
void PageFile::prefetch_blocks(std::span<const std::uint32_t> pages,
                               Clock::time_point end) const noexcept {
  ByteRange ranges[kMaxRanges];
  for (unsigned level = 0; level < DirectoryShape::kMaxLevels; ++level) {
    std::size_t count = 0;
    for (const std::uint32_t page : pages) {
      if (page >= page_count() || directory_->try_entry(*source_, header_, page)) continue;
      if (const auto block = directory_->missing_block(header_, page)) ranges[count++] = *block;
    }
    const auto left = time_until(end);
    if (count == 0 || left.count() <= 0) return;
    source_->prefetch_within(std::span(ranges).first(count), left);
  }
}

void PageFile::prefetch_pages(std::span<const std::uint32_t> pages,
                              Clock::time_point end) const noexcept {
  ByteRange ranges[kMaxRanges];
  std::size_t count = 0;
  for (const std::uint32_t page : pages) {
    if (page >= page_count()) continue;
    if (const auto found = directory_->try_entry(*source_, header_, page))
      ranges[count++] = {found->offset, found->stored_bytes};
  }
  const auto left = time_until(end);
  if (count == 0 || left.count() <= 0) return;
  source_->prefetch_within(std::span(ranges).first(count), left);
}

bool PageFile::is_here(std::uint32_t page) const noexcept {
  const std::optional<PageEntry> entry = kept_entry(page);
  return entry && source_->is_here({entry->offset, entry->stored_bytes});
}

Result<bool> PageFile::try_read_page(std::uint32_t page, std::span<std::byte> stored_scratch,
                                     std::span<std::byte> raw_out,
                                     const ReadLimits& terms) const noexcept {
  if (const Result<void> checked = check_page(page); !checked) return checked.error();
  const std::optional<PageEntry> entry = kept_entry(page);
  if (!entry) return false;
  if (const auto checked = check_buffers(page, *entry, stored_scratch, raw_out); !checked)
    return checked.error();
  const std::span<std::byte> stored = stored_scratch.first(entry->stored_bytes);
  if (!source_->try_read(entry->offset, stored, terms)) return false;
  const Result<void> unpacked = unpack(page, *entry, stored, raw_out);
  if (unpacked) return true;
  // Where the source may have other bytes, read_page() asks for them.
  if (source_->forget({entry->offset, entry->stored_bytes})) return false;
  return unpacked.error();
}

}  // namespace planetree::storage
