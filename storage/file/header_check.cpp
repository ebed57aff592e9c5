#include "storage/file/header_check.h"

#include <algorithm>
#include <bit>
#include <cinttypes>
#include <cmath>
#include <cstring>
#include <iterator>

#include "storage/file/directory_shape.h"
#include "storage/file/header_faults.h"
#include "storage/file/page_codec.h"

namespace planetree::storage {
namespace {

Result<void> check_supported(const FileHeader& header) noexcept {
  if (!is_known_version(header.version)) return unknown_version(header.version);
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
  // The file's length bounds the directory before memory is allocated for it.
  if (header.extension_count > kMaxExtensions ||
      pages_start(header) + kHeaderBytes > header.file_bytes) {
    return bad_header(offsetof(FileHeader, page_count), "the directory does not fit in the file");
  }
  std::uint64_t left = header.file_bytes - kHeaderBytes - pages_start(header);
  for (const std::uint64_t bytes : header.stored_bytes) {
    if (bytes > left)
      return bad_header(offsetof(FileHeader, stored_bytes), "the pages do not fit in the file");
    left -= bytes;
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

}  // namespace planetree::storage
