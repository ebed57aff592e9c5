#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "planetree/error.h"
#include "storage/file/directory_check.h"
#include "storage/file/directory_shape.h"
#include "storage/file/file_layout.h"
#include "storage/system/byte_source.h"

namespace planetree::storage {

/// The directory of an open file. Each block is checked when it is read.
///
/// Up to kMaxBlocks blocks are kept in memory. A directory that has no more is read whole when the
/// file is opened; one of another machine only if it ends within kMaxRemoteBytes of the file. Of a
/// greater one, the root is read then and other blocks when they are needed; those that were used
/// last stay.
///
/// threads  any number at once; none waits for the reads of another
class Directory {
 public:
  static constexpr std::uint64_t kMaxBlocks = 256;  ///< hold the entries of 130,560 pages, in 3 MiB

  /// Bytes from the start of a remote file on that are read when it is opened.
  static constexpr std::uint64_t kMaxRemoteBytes = std::uint64_t{1} << 19;

  /// Allocates no more memory than the directory is long.
  ///
  /// header  must have passed check_header()
  /// errors  kNoMemory, kReadFailed, kDamaged
  static Result<Directory> open(const ByteSource& source, const FileHeader& header) noexcept;

  /// Returns where a page is.
  ///
  /// page    below header.page_count
  /// errors  kReadFailed, kTruncated, kDamaged
  Result<PageEntry> entry(const ByteSource& source, const FileHeader& header,
                          std::uint32_t page) const noexcept;
  /// Returns the same if that reads nothing from the file. Waits for no thread that reads.
  std::optional<PageEntry> kept_entry(const FileHeader& header, std::uint32_t page) const noexcept;
  /// Returns where the first block is that entry() would read, or nothing if it would read none.
  std::optional<ByteRange> missing_block(const FileHeader& header,
                                         std::uint32_t page) const noexcept;
  /// Returns the same as entry() if ByteSource::try_read() gives the blocks that it needs.
  std::optional<PageEntry> try_entry(const ByteSource& source, const FileHeader& header,
                                     std::uint32_t page) const noexcept;

  /// Bytes of memory that the blocks take.
  std::uint64_t memory_bytes() const noexcept {
    return slot_count_ == 1 ? shape_.bytes() : slot_count_ * DirectoryShape::kBlockBytes;
  }

 private:
  struct Slot {
    std::uint64_t number = kNothing;  // of the block, counted from the root on
    std::uint64_t last_use = 0;
  };
  struct Kept {
    std::mutex mutex;
    std::uint64_t uses = 0;
    std::unique_ptr<Slot[]> slots;
    std::unique_ptr<std::byte[]> bytes;
  };
  static constexpr std::uint64_t kNothing = ~std::uint64_t{0};

  explicit Directory(std::uint32_t page_count) noexcept : shape_(page_count) {}
  Result<void> read_all(const ByteSource& source, const FileHeader& header) noexcept;
  bool has_slot_for_all() const noexcept { return slot_count_ == shape_.blocks(); }
  bool reads_all_at_open(const ByteSource& source, const FileHeader& header) const noexcept;
  // A step down from a block: to a block below, or to the entry of the page.
  struct Step {
    DirectoryPlace place;
    std::optional<PageEntry> entry;
  };
  using Read = Result<void> (*)(const ByteSource& source, std::uint64_t offset,
                                std::span<std::byte> out) noexcept;

  Result<PageEntry> find(const ByteSource& source, const FileHeader& header, std::uint32_t page,
                         Read read) const noexcept;
  std::optional<PageEntry> find_kept(const FileHeader& header, std::uint32_t page,
                                     DirectoryPlace& place) const noexcept;
  std::optional<Step> kept_step(const FileHeader& header, const DirectoryPlace& place,
                                std::uint32_t page) const noexcept;
  Step step(const FileHeader& header, const DirectoryPlace& place, std::span<const std::byte> block,
            std::uint32_t page) const noexcept;
  Result<Step> read_step(const ByteSource& source, const FileHeader& header,
                         const DirectoryPlace& place, std::uint32_t page, Read read) const noexcept;
  void keep(const DirectoryPlace& place, std::span<const std::byte> block) const noexcept;
  std::uint64_t number_of(const DirectoryPlace& place) const noexcept;
  std::size_t block_bytes(const DirectoryPlace& place) const noexcept;
  std::uint64_t slot_of(std::uint64_t number) const noexcept;

  DirectoryShape shape_;
  std::uint64_t slot_count_ = 0;
  bool is_complete_ = false;  // all blocks are in memory for good
  std::unique_ptr<Kept> kept_;
};

}  // namespace planetree::storage
