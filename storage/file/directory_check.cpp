#include "storage/file/directory_check.h"

#include "storage/file/checksum.h"
#include "storage/file/header_faults.h"
#include "storage/file/page_codec.h"

namespace planetree::storage {
namespace {

class BlockRules {
 public:
  BlockRules(const FileHeader& header, const DirectoryShape& shape, const DirectoryPlace& place,
             std::span<const std::byte> bytes) noexcept
      : header_(header), shape_(shape), place_(place), bytes_(bytes) {}

  Result<void> check() const noexcept {
    if (!has_hash()) return fault("the hash of a part of the directory is wrong");
    return place_.level == shape_.page_level() ? check_pages() : check_blocks();
  }

 private:
  std::size_t count() const noexcept { return shape_.block_entries(place_.level, place_.block); }
  Error fault(const char* cause) const noexcept {
    return damaged(Error::kNowhere,
                   directory_block_start(header_, shape_, place_.level, place_.block), cause);
  }
  Error fault_of_page(std::uint32_t page, const char* cause) const noexcept {
    return damaged(
        page, directory_block_start(header_, shape_, place_.level, 0) + page * kDirectoryEntryBytes,
        cause);
  }

  bool has_hash() const noexcept {
    if (bytes_.size() != count() * kDirectoryEntryBytes) return false;
    if (place_.level > 0) return hash64(bytes_) == place_.check;
    return hash128(bytes_) == Hash128{header_.content_id[0], header_.content_id[1]};
  }

  // Whether the order of octcodes starts anew at a page.
  bool starts_section(std::uint32_t page) const noexcept {
    return page == 0 || page == header_.first_cap_page() || page == header_.first_field_page() ||
           page == header_.first_attribute_page() || page == header_.first_mask_page();
  }

  // Mask pages have no ordinals, so that their octcodes ascend strictly.
  bool follows(std::uint64_t before, std::uint64_t octcode, std::uint32_t page) const noexcept {
    return page > header_.first_mask_page() ? before < octcode : before <= octcode;
  }

  const char* fault_of(const DirectoryPage& entry) const noexcept {
    if (entry.raw_bytes > header_.max_raw_bytes)
      return "the page's raw length is above the file's largest";
    if (entry.stored_bytes == 0 || entry.stored_bytes > header_.max_stored_bytes)
      return "the page's stored length is zero or above the file's largest";
    const Codec codec = page_entry(entry, 0).codec();
    return lengths_are_plausible(codec, entry.stored_bytes, entry.raw_bytes)
               ? nullptr
               : "the page's stored length cannot give its raw length";
  }

  // The sums cannot overflow: they have at most 2^32 terms of 32 bits each.
  Result<void> check_pages() const noexcept {
    std::uint64_t offset = place_.start, octcode = place_.octcode;
    for (std::size_t i = 0; i < count(); ++i) {
      const auto page = static_cast<std::uint32_t>(place_.block * DirectoryShape::kFanOut + i);
      const auto entry = directory_entry<DirectoryPage>(bytes_, i);
      if (const char* cause = fault_of(entry)) return fault_of_page(page, cause);
      if (i == 0 ? place_.level > 0 && entry.octcode != octcode
                 : !follows(octcode, entry.octcode, page) && !starts_section(page))
        return fault_of_page(page, "the page's octcode does not follow the one before");
      octcode = entry.octcode;
      offset += entry.stored_bytes;
    }
    if (offset == place_.end) return {};
    return fault("the pages of a part of the directory do not end where the next part begins");
  }

  Result<void> check_blocks() const noexcept {
    std::uint64_t start = place_.start;
    for (std::size_t i = 0; i < count(); ++i) {
      const auto entry = directory_entry<DirectoryBlock>(bytes_, i);
      if (i == 0 ? entry.offset != start || (place_.level > 0 && entry.octcode != place_.octcode)
                 : entry.offset <= start)
        return fault("the parts of the directory are not in their order");
      start = entry.offset;
    }
    if (start < place_.end) return {};
    return fault("a part of the directory begins where the pages have ended");
  }

  const FileHeader& header_;
  const DirectoryShape& shape_;
  const DirectoryPlace& place_;
  const std::span<const std::byte> bytes_;
};

}  // namespace

DirectoryPlace place_below(const DirectoryShape& shape, const DirectoryPlace& place,
                           std::span<const std::byte> block, std::size_t index) noexcept {
  const auto entry = directory_entry<DirectoryBlock>(block, index);
  DirectoryPlace below;
  below.level = place.level + 1;
  below.block = place.block * DirectoryShape::kFanOut + index;
  below.check = entry.check;
  below.octcode = entry.octcode;
  below.start = entry.offset;
  below.end = index + 1 < shape.block_entries(place.level, place.block)
                  ? directory_entry<DirectoryBlock>(block, index + 1).offset
                  : place.end;
  return below;
}

Result<void> check_directory_block(const FileHeader& header, const DirectoryShape& shape,
                                   const DirectoryPlace& place,
                                   std::span<const std::byte> bytes) noexcept {
  return BlockRules(header, shape, place, bytes).check();
}

}  // namespace planetree::storage
