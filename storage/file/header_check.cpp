#include "storage/file/header_check.h"

#include <algorithm>
#include <bit>
#include <cinttypes>
#include <cmath>
#include <cstring>
#include <iterator>

#include "storage/file/checksum.h"
#include "storage/file/header_faults.h"
#include "storage/file/page_codec.h"

namespace planetree::storage {
namespace {

Error bad_entry(std::uint32_t page, const char* cause) noexcept {
  return damaged(page, table_end(page), cause);
}

Result<void> check_supported(const FileHeader& header) noexcept {
  if (header.version != kFormatVersion) {
    return make_error(ErrorCode::kUnsupported, Error::kNowhere, offsetof(FileHeader, version),
                      "the file has format version %d and this program reads version %d; use a "
                      "planetree of that version or build the file again",
                      header.version, kFormatVersion);
  }
  const std::uint64_t unknown = header.incompatible_features & ~kKnownIncompatibleFeatures;
  if (unknown != 0) {
    return make_error(ErrorCode::kUnsupported, Error::kNowhere,
                      offsetof(FileHeader, incompatible_features),
                      "the file needs feature bits %#" PRIx64
                      " that this program does not know; update planetree or build the file again",
                      unknown);
  }
  return {};
}

Result<void> check_lengths(const FileHeader& header, std::uint64_t actual_bytes) noexcept {
  if (header.file_bytes != actual_bytes) {
    return make_error(ErrorCode::kTruncated, Error::kNowhere,
                      std::min(header.file_bytes, actual_bytes),
                      "the file should have %" PRIu64 " bytes and has %" PRIu64
                      "; restore it from a copy or build it again",
                      header.file_bytes, actual_bytes);
  }
  if (header.page_count == 0) {
    return bad_header(offsetof(FileHeader, page_count), "the header states that there is no page");
  }
  // A page has at least one byte, so the file's length bounds the page table before memory is
  // allocated for it.
  if (table_end(header.page_count) + header.page_count + kHeaderBytes > header.file_bytes) {
    return bad_header(offsetof(FileHeader, page_count), "the page table does not fit in the file");
  }
  if (header.max_raw_bytes == 0 || header.max_raw_bytes > kMaxRawBytes) {
    return bad_header(offsetof(FileHeader, max_raw_bytes), "the largest raw page is out of range");
  }
  if (header.max_stored_bytes == 0 || header.max_stored_bytes > header.max_raw_bytes) {
    return bad_header(offsetof(FileHeader, max_stored_bytes),
                      "the largest stored page is out of range");
  }
  return {};
}

Result<void> check_entry(const FileHeader& header, std::uint32_t page,
                         const PageEntry& entry) noexcept {
  if (entry.codec != Codec::kStored && entry.codec != Codec::kLz4) {
    return bad_entry(page, "the page's codec is unknown");
  }
  if (entry.raw_bytes > header.max_raw_bytes) {
    return bad_entry(page, "the page's raw length is above the file's largest");
  }
  if (entry.stored_bytes == 0 || entry.stored_bytes > header.max_stored_bytes) {
    return bad_entry(page, "the page's stored length is zero or above the file's largest");
  }
  if (!lengths_are_plausible(entry.codec, entry.stored_bytes, entry.raw_bytes)) {
    return bad_entry(page, "the page's stored length cannot give its raw length");
  }
  return {};
}

bool key_less(const PageEntry& a, const PageEntry& b) noexcept {
  return a.octcode != b.octcode ? a.octcode < b.octcode : a.ordinal < b.ordinal;
}

// Checks that the pages fill the file. The sums cannot overflow: they have page_count terms of 32
// bits each.
Result<void> check_tiling(const FileHeader& header, std::span<const PageEntry> entries) noexcept {
  std::uint64_t offset = table_end(header.page_count);
  std::uint32_t max_raw_bytes = 0;
  std::uint32_t max_stored_bytes = 0;
  for (std::uint32_t page = 0; page < header.page_count; ++page) {
    const PageEntry& entry = entries[page];
    if (entry.offset != offset) {
      return bad_entry(page, "the page does not start where the one before ends");
    }
    if (const Result<void> checked = check_entry(header, page, entry); !checked) return checked;
    if (page > 0 && page != header.first_cap_page() && page != header.first_field_page() &&
        page != header.first_attribute_page() && page != header.first_mask_page() &&
        !key_less(entries[page - 1], entry)) {
      return bad_entry(page, "the page's key does not follow the one before");
    }
    offset += entry.stored_bytes;
    max_raw_bytes = std::max(max_raw_bytes, entry.raw_bytes);
    max_stored_bytes = std::max(max_stored_bytes, entry.stored_bytes);
  }
  if (offset != header.file_bytes - kHeaderBytes) {
    return bad_entry(header.page_count - 1, "the pages do not end where the header's copy starts");
  }
  // Readers allocate buffers of these sizes, so they must not exceed what the pages need.
  if (max_raw_bytes != header.max_raw_bytes || max_stored_bytes != header.max_stored_bytes) {
    return bad_header(offsetof(FileHeader, max_raw_bytes),
                      "no page is as large as the header states");
  }
  return {};
}

// Number of pages that the points of the field take; more than any file has if there are too many.
std::uint64_t field_pages(const FileHeader& header) noexcept {
  const std::uint64_t in_page = header.page_bytes / kFieldPointShare;
  std::uint64_t points = 1;
  for (const std::uint32_t size : header.model.field_size) {
    points *= size;
    if (points > kMaxFieldPoints) return ~std::uint64_t{0};
  }
  return (points + in_page - 1) / in_page;
}

// Number of pages that the attributes take; more than any file has if the indices are too many.
std::uint64_t attribute_pages(const FileHeader& header) noexcept {
  if (header.model.attributes == 0) return 0;
  const std::uint64_t in_page =
      (header.page_bytes - kAttributeHeadBytes) / header.model.attribute_bytes();
  return (header.model.index_count() - 1) / in_page + 1;
}

}  // namespace

Result<void> check_header(const FileHeader& header, std::uint64_t actual_bytes) noexcept {
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0) {
    return bad_header(offsetof(FileHeader, magic), "the header's first bytes are wrong");
  }
  if (const Result<void> checked = check_supported(header); !checked) return checked;
  if (header.header_bytes != kHeaderBytes) {
    return bad_header(offsetof(FileHeader, header_bytes), "the header's length is wrong");
  }
  if (const Result<void> checked = check_lengths(header, actual_bytes); !checked) return checked;
  if (!std::has_single_bit(header.page_bytes) || header.page_bytes < kMinPageBytes ||
      header.page_bytes > kMaxPageBytes) {
    return bad_header(offsetof(FileHeader, page_bytes),
                      "the page size is not a power of two from 4096 to 262144");
  }
  if (!all_zero(header.reserved)) {
    return bad_header(offsetof(FileHeader, reserved), "the header's reserved bytes are not zero");
  }
  if (std::uint64_t{header.model.mask_page_count} + header.model.attribute_page_count +
          header.model.field_page_count + header.model.cap_page_count >=
      header.page_count) {
    return bad_model(offsetof(ModelRecord, mask_page_count), "there is no page of the tree");
  }
  if (field_pages(header) != header.model.field_page_count) {
    return bad_model(offsetof(ModelRecord, field_page_count),
                     "the field has not as many pages as its points take");
  }
  if (const Result<void> checked = check_model(header.model); !checked) return checked;
  if (attribute_pages(header) != header.model.attribute_page_count) {
    return bad_model(offsetof(ModelRecord, attribute_page_count),
                     "there are not as many attribute pages as the triangles take");
  }
  return {};
}

Result<void> check_table(const FileHeader& header, std::span<const PageEntry> entries) noexcept {
  if (entries.size() != header.page_count || table_hash(entries) != header.table_hash) {
    return damaged(Error::kNowhere, kHeaderBytes, "the page table's checksum is wrong");
  }
  const Hash128 id = content_id(entries, header.content_id[0]);
  if (id != Hash128{header.content_id[0], header.content_id[1]}) {
    return damaged(Error::kNowhere, offsetof(FileHeader, content_id),
                   "the content id does not follow from the page table");
  }
  return check_tiling(header, entries);
}

}  // namespace planetree::storage
