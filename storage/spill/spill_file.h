#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "planetree/error.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// Bytes put away while a build works: in memory as far as allowed, then on disk. The file has
/// no name, so that the system takes it back however the process ends; it is made when it is
/// needed. Or it is one with a name, for what shall outlive the process.
///
/// threads  any number may append and read what was appended.
class SpillFile {
 public:
  /// directory   where there is room for it.
  /// held_bytes  may stay in memory, which is taken as it is needed.
  /// calls       the system; must outlive this.
  SpillFile(std::filesystem::path directory, std::uint64_t held_bytes,
            FileCalls& calls = FileCalls::real());

  /// file        open for reading and writing; all goes there,
  /// size_bytes  behind its first bytes, which can be read.
  SpillFile(FileHandle file, std::uint64_t size_bytes);

  /// Puts bytes away; returns where. Parts of one call are side by side.
  /// errors  kNotFound, kPermission, kNoSpace, kWriteFailed and the like.
  Result<std::uint64_t> append(std::span<const std::byte> bytes);

  /// Gets bytes back.
  /// errors  kReadFailed, kTruncated.
  Result<void> read(std::uint64_t offset, std::span<std::byte> out) const;

  /// Makes what was put away durable, in a file with a name.
  /// errors  as FileHandle::sync_data(); all later calls fail too.
  Result<void> sync();

  /// Bytes put away so far.
  std::uint64_t size_bytes() const noexcept { return next_.load(std::memory_order_relaxed); }
  /// Those of them that are on disk.
  std::uint64_t disk_bytes() const noexcept {
    return size_bytes() - std::min(size_bytes(), held_bytes_);
  }
  /// Whether putting something away, getting it back or making it durable ever failed.
  bool failed() const noexcept { return failed_.load(std::memory_order_relaxed); }

 private:
  Result<void> open();
  Result<void> write(std::uint64_t offset, std::span<const std::byte> bytes);
  // How many of some bytes from `offset` on are in memory: the first.
  std::size_t held_part(std::uint64_t offset, std::size_t bytes) const noexcept {
    return offset < held_bytes_ ? std::min<std::uint64_t>(bytes, held_bytes_ - offset) : 0;
  }

  const std::filesystem::path directory_;
  const std::uint64_t held_bytes_ = 0;
  const std::unique_ptr<std::byte[]> held_;
  FileCalls& calls_;
  std::once_flag opened_once_;
  std::optional<Error> open_failure_;
  FileHandle file_;
  std::atomic<std::uint64_t> next_ = 0;
  mutable std::atomic<bool> failed_ = false;
  std::mutex syncing_;
  std::optional<Error> sync_failure_;
};

}  // namespace planetree::storage
