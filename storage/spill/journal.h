#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>

#include "planetree/error.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// What a process notes down for a later one, record after record, each with a checksum. What
/// the process was at when it ended is a torn record at the end, which counts for nothing.
class Journal {
 public:
  /// Takes a record; false: it is not to be believed, and neither is what comes behind it.
  using Take = std::function<bool(std::uint32_t kind, std::span<const std::byte> payload)>;

  /// file  open for reading and writing.
  explicit Journal(FileHandle file) noexcept : file_(std::move(file)) {}

  /// Hands out the whole records in their order, and cuts off the rest of the file, durably.
  /// Call it once, before anything is appended.
  /// errors  as FileHandle.
  Result<void> replay(const Take& take);

  /// Adds a record; it is durable on return. Any number of threads.
  /// errors  as FileHandle, kNoSpace among them; all later calls fail too.
  Result<void> append(std::uint32_t kind, std::span<const std::byte> payload);

  /// Of the records.
  std::uint64_t size_bytes() const {
    const std::lock_guard lock(mutex_);
    return size_bytes_;
  }
  /// Whether appending ever failed.
  bool failed() const {
    const std::lock_guard lock(mutex_);
    return failure_.has_value();
  }

 private:
  FileHandle file_;
  mutable std::mutex mutex_;
  std::uint64_t size_bytes_ = 0;
  std::optional<Error> failure_;
};

}  // namespace planetree::storage
