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
#include <vector>

#include "planetree/error.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

class ResultFile;

/// Temporary bytes of a build: in memory up to a limit, then in a file. The file is created when it
/// is first needed and has no name, so that the system removes it however the process ends. A
/// SpillFile may also use a file with a name, for data that must outlive the process, and bytes of
/// result files can be read through it as if they were its own.
///
/// threads  any number may append, and read bytes that have been appended or attached. attach() is
///          to be called before other threads use the object.
class SpillFile {
 public:
  /// directory   directory of the file.
  /// held_bytes  maximum number of bytes kept in memory; the memory is reserved now but backed only
  ///             when written.
  /// calls       the system; must outlive this object.
  SpillFile(std::filesystem::path directory, std::uint64_t held_bytes,
            FileCalls& calls = FileCalls::real());

  /// Uses a file with a name and keeps nothing in memory.
  ///
  /// file        open for reading and writing.
  /// size_bytes  length of the data already in the file; it can be read, and bytes are appended
  ///             after it.
  SpillFile(FileHandle file, std::uint64_t size_bytes);
  /// Uses an empty file that another object owns, and keeps nothing in memory.
  ///
  /// file  open for reading and writing; must outlive this object, and stay where it is.
  explicit SpillFile(const FileHandle& file);

  /// Most bytes that can be appended; offsets of attached files are above it.
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 48;
  /// Most files that can be attached.
  static constexpr std::size_t kMaxAttached = (std::size_t{1} << 16) - 1;
  /// Makes the data of a result file readable: byte i of it is at the returned offset plus i.
  std::uint64_t attach(std::shared_ptr<const ResultFile> file);

  /// Appends bytes and returns their offset. The bytes of one call are contiguous.
  /// errors  those of file_error(), such as kNotFound, kPermission, kNoSpace, kWriteFailed.
  Result<std::uint64_t> append(std::span<const std::byte> bytes);

  /// Reads bytes that were appended before.
  /// errors  kReadFailed, kTruncated; kDamaged: attached bytes are not those that were written.
  Result<void> read(std::uint64_t offset, std::span<std::byte> out) const;

  /// Makes the appended bytes durable. For files with a name.
  /// errors  those of FileHandle::sync_data(); after an error all later calls of sync() fail too.
  Result<void> sync();

  /// Bytes appended so far.
  std::uint64_t size_bytes() const noexcept { return next_.load(std::memory_order_relaxed); }
  /// Bytes of these that are not in memory.
  std::uint64_t disk_bytes() const noexcept {
    return size_bytes() - std::min(size_bytes(), held_bytes_);
  }
  /// Whether any append(), read() or sync() has failed.
  bool failed() const noexcept { return failed_.load(std::memory_order_relaxed); }

 private:
  Result<void> open();
  Result<void> write(std::uint64_t offset, std::span<const std::byte> bytes);
  // Number of bytes of a range that are in memory. They are the first ones of the range.
  std::size_t held_part(std::uint64_t offset, std::size_t bytes) const noexcept {
    return offset < held_bytes_ ? std::min<std::uint64_t>(bytes, held_bytes_ - offset) : 0;
  }

  const std::filesystem::path directory_;
  const std::uint64_t held_bytes_ = 0;
  const std::unique_ptr<std::byte[]> held_;
  FileCalls& calls_;
  std::once_flag opened_once_;
  std::optional<Error> open_failure_;
  FileHandle own_;
  const FileHandle* const file_ = &own_;
  std::vector<std::shared_ptr<const ResultFile>> attached_;
  std::atomic<std::uint64_t> next_ = 0;
  mutable std::atomic<bool> failed_ = false;
  std::mutex syncing_;
  std::optional<Error> sync_failure_;
};

}  // namespace planetree::storage
