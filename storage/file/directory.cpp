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

Result<void> read_block(const ByteSource& source, std::uint64_t offset,
                        std::span<std::byte> out) noexcept {
  return source.read_at(offset, out, "read the directory");
}

Result<void> try_to_read_block(const ByteSource& source, std::uint64_t offset,
                               std::span<std::byte> out) noexcept {
  if (source.try_read(offset, out, {})) return {};
  return make_error(ErrorCode::kReadFailed, Error::kNowhere, offset,
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
  const auto root = opened.read_step(source, header, DirectoryPlace::root(header), 0, read_block);
  if (!root) return root.error();
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
    if (const auto read = entry(source, header, page); !read) return read.error();
  }
  return {};
}

Result<PageEntry> Directory::entry(const ByteSource& source, const FileHeader& header,
                                   std::uint32_t page) const noexcept {
  return find(source, header, page, read_block);
}

std::optional<PageEntry> Directory::try_entry(const ByteSource& source, const FileHeader& header,
                                              std::uint32_t page) const noexcept {
  const auto found = find(source, header, page, try_to_read_block);
  return found ? std::optional(*found) : std::nullopt;
}

std::optional<PageEntry> Directory::kept_entry(const FileHeader& header,
                                               std::uint32_t page) const noexcept {
  DirectoryPlace place = DirectoryPlace::root(header);
  return find_kept(header, page, place);
}

std::optional<ByteRange> Directory::missing_block(const FileHeader& header,
                                                  std::uint32_t page) const noexcept {
  DirectoryPlace place = DirectoryPlace::root(header);
  if (find_kept(header, page, place)) return {};
  return ByteRange{directory_block_start(header, shape_, place.level, place.block),
                   block_bytes(place)};
}

// Goes down from the root. Reads the blocks that are not in memory.
Result<PageEntry> Directory::find(const ByteSource& source, const FileHeader& header,
                                  std::uint32_t page, Read read) const noexcept {
  DirectoryPlace place = DirectoryPlace::root(header);
  for (;;) {
    if (const auto entry = find_kept(header, page, place)) return *entry;
    const auto done = read_step(source, header, place, page, read);
    if (!done) return done.error();
    if (done->entry) return *done->entry;
    place = done->place;
  }
}

// Goes down from `place` through blocks that are in memory. Sets it to the first one that is not.
std::optional<PageEntry> Directory::find_kept(const FileHeader& header, std::uint32_t page,
                                              DirectoryPlace& place) const noexcept {
  std::unique_lock<std::mutex> lock(kept_->mutex, std::defer_lock);
  if (!is_complete_) lock.lock();
  while (const auto done = kept_step(header, place, page)) {
    if (done->entry) return done->entry;
    place = done->place;
  }
  return {};
}

std::optional<Directory::Step> Directory::kept_step(const FileHeader& header,
                                                    const DirectoryPlace& place,
                                                    std::uint32_t page) const noexcept {
  const std::uint64_t number = number_of(place);
  const std::uint64_t at = slot_of(number);
  Slot& slot = kept_->slots[at];
  if (slot.number != number) return {};
  if (!is_complete_) slot.last_use = ++kept_->uses;
  const std::byte* const bytes = kept_->bytes.get() + at * DirectoryShape::kBlockBytes;
  return step(header, place, {bytes, block_bytes(place)}, page);
}

Directory::Step Directory::step(const FileHeader& header, const DirectoryPlace& place,
                                std::span<const std::byte> block,
                                std::uint32_t page) const noexcept {
  if (place.level == shape_.page_level())
    return {place, entry_in(header, place, block, page % DirectoryShape::kFanOut)};
  const std::uint64_t below = shape_.block_of_page(place.level + 1, page);
  return {
      place_below(shape_, place, block, static_cast<std::size_t>(below % DirectoryShape::kFanOut)),
      {}};
}

// Reads a block without the mutex, so that no thread waits for a read that it does not need.
Result<Directory::Step> Directory::read_step(const ByteSource& source, const FileHeader& header,
                                             const DirectoryPlace& place, std::uint32_t page,
                                             Read read) const noexcept {
  std::byte memory[DirectoryShape::kBlockBytes];
  const std::span<std::byte> bytes(memory, block_bytes(place));
  const std::uint64_t offset = directory_block_start(header, shape_, place.level, place.block);
  if (const auto done = read(source, offset, bytes); !done) return done.error();
  if (const auto checked = check_directory_block(header, shape_, place, bytes); !checked)
    return checked.error();
  keep(place, bytes);
  return step(header, place, bytes, page);
}

void Directory::keep(const DirectoryPlace& place, std::span<const std::byte> block) const noexcept {
  const std::scoped_lock lock(kept_->mutex);
  const std::uint64_t number = number_of(place);
  const std::uint64_t at = slot_of(number);
  std::copy(block.begin(), block.end(), kept_->bytes.get() + at * DirectoryShape::kBlockBytes);
  kept_->slots[at] = {number, ++kept_->uses};
}

// The number of a block, counted from the root on.
std::uint64_t Directory::number_of(const DirectoryPlace& place) const noexcept {
  std::uint64_t number = place.block;
  for (unsigned level = 0; level < place.level; ++level) number += shape_.blocks(level);
  return number;
}

std::size_t Directory::block_bytes(const DirectoryPlace& place) const noexcept {
  return shape_.block_entries(place.level, place.block) * kDirectoryEntryBytes;
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
