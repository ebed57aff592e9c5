#include "storage/file/directory.h"

#include <algorithm>
#include <new>

namespace planetree::storage {
namespace {

// The entry of a page in its block. Offsets of pages are sums of the lengths before them.
PageEntry entry_in(const FileHeader& header, const DirectoryPlace& place,
                   std::span<const std::byte> block, std::size_t index) noexcept {
  std::uint64_t offset = pages_start(header) + place.start;
  for (std::size_t i = 0; i < index; ++i)
    offset += directory_entry<DirectoryPage>(block, i).stored_bytes;
  return page_entry(directory_entry<DirectoryPage>(block, index), offset);
}

Error not_kept() noexcept {
  return make_error(ErrorCode::kReadFailed, Error::kNowhere, Error::kNowhere,
                    "a part of the directory is not in memory; read it");
}

}  // namespace

Result<Directory> Directory::open(const ByteSource& source, const FileHeader& header) noexcept {
  Directory opened(header.page_count);
  opened.slot_count_ = std::min(opened.shape_.blocks(), kMaxBlocks);
  opened.kept_.reset(new (std::nothrow) Kept);
  if (opened.kept_) {
    opened.kept_->slots.reset(new (std::nothrow) Slot[opened.slot_count_]);
    opened.kept_->bytes.reset(new (std::nothrow) std::byte[opened.memory_bytes()]);
  }
  if (!opened.kept_ || !opened.kept_->slots || !opened.kept_->bytes)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere,
                      directory_start(header.extension_count),
                      "no memory for the directory of %llu bytes; free some memory",
                      static_cast<unsigned long long>(opened.memory_bytes()));
  if (const auto root = opened.block(&source, header, DirectoryPlace::root(header)); !root)
    return root.error();
  if (!opened.reads_all_at_open(source, header)) return opened;
  if (const auto done = opened.read_all(source, header); !done) return done.error();
  opened.is_complete_ = true;
  return opened;
}

bool Directory::reads_all_at_open(const ByteSource& source,
                                  const FileHeader& header) const noexcept {
  return has_slot_for_all() && (!source.is_remote() || pages_start(header) <= kMaxRemoteBytes);
}

Result<void> Directory::read_all(const ByteSource& source, const FileHeader& header) noexcept {
  const std::uint64_t blocks = shape_.blocks(shape_.page_level());
  for (std::uint64_t block = 0; block < blocks; ++block) {
    const auto page = static_cast<std::uint32_t>(block * DirectoryShape::kFanOut);
    if (const auto read = find(&source, header, page); !read) return read.error();
  }
  return {};
}

Result<PageEntry> Directory::entry(const ByteSource& source, const FileHeader& header,
                                   std::uint32_t page) const noexcept {
  if (is_complete_) return find(nullptr, header, page);
  const std::scoped_lock lock(kept_->mutex);
  return find(&source, header, page);
}

std::optional<PageEntry> Directory::kept_entry(const FileHeader& header,
                                               std::uint32_t page) const noexcept {
  std::unique_lock<std::mutex> lock(kept_->mutex, std::defer_lock);
  if (!is_complete_) lock.lock();
  const auto found = find(nullptr, header, page);
  if (!found) return {};
  return *found;
}

// Goes down from the root. Without `source`, only through blocks that are in memory.
Result<PageEntry> Directory::find(const ByteSource* source, const FileHeader& header,
                                  std::uint32_t page) const noexcept {
  DirectoryPlace place = DirectoryPlace::root(header);
  auto bytes = block(source, header, place);
  while (bytes && place.level < shape_.page_level()) {
    const std::uint64_t below = shape_.block_of_page(place.level + 1, page);
    place = place_below(shape_, place, *bytes,
                        static_cast<std::size_t>(below % DirectoryShape::kFanOut));
    bytes = block(source, header, place);
  }
  if (!bytes) return bytes.error();
  return entry_in(header, place, *bytes, page % DirectoryShape::kFanOut);
}

Result<std::span<const std::byte>> Directory::block(const ByteSource* source,
                                                    const FileHeader& header,
                                                    const DirectoryPlace& place) const noexcept {
  std::uint64_t number = place.block;
  for (unsigned level = 0; level < place.level; ++level) number += shape_.blocks(level);
  const std::uint64_t at = slot_of(number);
  Slot& slot = kept_->slots[at];
  const std::span<std::byte> bytes(
      kept_->bytes.get() + at * DirectoryShape::kBlockBytes,
      shape_.block_entries(place.level, place.block) * kDirectoryEntryBytes);
  if (slot.number != number) {
    if (!source) return not_kept();
    slot.number = kNothing;
    if (const auto done = read(*source, header, place, bytes); !done) return done.error();
    slot.number = number;
  }
  if (!is_complete_) slot.last_use = ++kept_->uses;
  return std::span<const std::byte>(bytes);
}

Result<void> Directory::read(const ByteSource& source, const FileHeader& header,
                             const DirectoryPlace& place, std::span<std::byte> out) const noexcept {
  const std::uint64_t offset = directory_block_start(header, shape_, place.level, place.block);
  if (const auto done = source.read_at(offset, out, "read the directory"); !done) return done;
  return check_directory_block(header, shape_, place, out);
}

// The slot of a block that is kept; otherwise that of the block whose last use is longest ago.
std::uint64_t Directory::slot_of(std::uint64_t number) const noexcept {
  if (has_slot_for_all()) return number;
  std::uint64_t oldest = 0;
  for (std::uint64_t slot = 0; slot < slot_count_; ++slot) {
    if (kept_->slots[slot].number == number) return slot;
    if (kept_->slots[slot].last_use < kept_->slots[oldest].last_use) oldest = slot;
  }
  return oldest;
}

}  // namespace planetree::storage
