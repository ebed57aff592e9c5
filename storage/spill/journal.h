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

/// Records that a process leaves for a later one, each with a checksum. If the process ends while
/// it appends a record, the file ends with an incomplete record, which is ignored.
class Journal {
 public:
  /// Receives a record. Returns false to reject this record and all that follow.
  using Take = std::function<bool(std::uint32_t kind, std::span<const std::byte> payload)>;

  /// file  open for reading and writing.
  explicit Journal(FileHandle file) noexcept : file_(std::move(file)) {}

  /// Passes the complete records to `take`, in their order, up to the first that is incomplete,
  /// damaged or rejected. Removes the rest of the file, durably. Call it once, before append().
  /// errors  those of FileHandle.
  Result<void> replay(const Take& take);

  /// Appends a record, which is durable when the call returns.
  /// errors   those of FileHandle, among them kNoSpace; after an error all later calls fail too.
  /// threads  any number at once.
  Result<void> append(std::uint32_t kind, std::span<const std::byte> payload);

  /// Total length of the records.
  std::uint64_t size_bytes() const {
    const std::lock_guard lock(mutex_);
    return size_bytes_;
  }
  /// Whether any append() has failed.
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
