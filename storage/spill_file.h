#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>

#include "planetree/error.h"
#include "storage/file_calls.h"
#include "storage/file_handle.h"

namespace planetree::storage {

/// Bytes put away on disk while a build works. The file has no name, so that the system
/// takes it back however the process ends; it is made when the first byte is put away.
///
/// threads  any number may append and read what was appended.
class SpillFile {
 public:
  /// directory  where there is room for it.
  /// calls      the system; must outlive this.
  explicit SpillFile(std::filesystem::path directory, FileCalls& calls = FileCalls::real());

  /// Puts bytes away; returns where. Parts of one call are side by side.
  /// errors  kNotFound, kPermission, kNoSpace, kWriteFailed and the like.
  Result<std::uint64_t> append(std::span<const std::byte> bytes);

  /// Gets bytes back.
  /// errors  kReadFailed, kTruncated.
  Result<void> read(std::uint64_t offset, std::span<std::byte> out) const;

  /// Bytes put away so far.
  std::uint64_t size_bytes() const noexcept { return next_.load(std::memory_order_relaxed); }

 private:
  Result<void> open();

  const std::filesystem::path directory_;
  FileCalls& calls_;
  std::once_flag opened_once_;
  std::optional<Error> failure_;
  FileHandle file_;
  std::atomic<std::uint64_t> next_ = 0;
};

}  // namespace planetree::storage
