#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/error.h"
#include "storage/file_calls.h"

namespace planetree::storage {

/// An open file, closed with the handle. Reads and writes name their offset,
/// so that any number of threads may share one.
class FileHandle {
 public:
  FileHandle() noexcept = default;
  FileHandle(FileHandle&& other) noexcept;
  FileHandle& operator=(FileHandle&& other) noexcept;
  ~FileHandle();

  /// As openat(2), close-on-exec, resumed when a signal interrupts it. On
  /// failure the handle is closed and errno says why.
  static FileHandle open(FileCalls& calls, int directory, const char* path, int flags,
                         mode_t mode = 0) noexcept;

  bool is_open() const noexcept { return descriptor_ >= 0; }
  int descriptor() const noexcept { return descriptor_; }
  FileCalls& calls() const noexcept { return *calls_; }
  void close() noexcept;

  /// Fills `out` from `offset`, through interruptions and short reads.
  /// what    is tried, as file_error() has it.
  /// errors  kTruncated: the file ends before; else as file_error().
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out,
                       const char* what = "read the file") const noexcept;

  /// Fills `out` from `offset` if the system has the bytes in memory. Else it is told to get them,
  /// and looked for them again and again for as long as `most`, without giving up the processor:
  /// for devices that answer sooner than a thread is put to sleep and woken. False where it takes
  /// longer, cannot be told, or fails: read_at() says why. `out` is lost then.
  ///
  /// soon_written  what the caller writes next: brought near the processor while the device works.
  bool read_soon(std::uint64_t offset, std::span<std::byte> out, std::chrono::microseconds most,
                 std::span<const std::byte> soon_written = {}) const noexcept;

  /// Writes all of `bytes` at `offset`, through interruptions and short writes.
  /// what    is tried, as file_error() has it.
  /// errors  as file_error(), kNoSpace among them.
  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes,
                        const char* what = "write the file") const noexcept;

  /// errors  as file_error().
  Result<std::uint64_t> size_bytes() const noexcept;

  /// Makes the file so long, durably.
  /// errors  as file_error().
  Result<void> truncate(std::uint64_t bytes) const noexcept;

  /// Makes what was written durable. After an error nothing is known of it, and a second call
  /// would not say so.
  /// errors  as file_error().
  Result<void> sync_data() const noexcept;

 private:
  enum class Look { kAll, kNotYet, kNever };
  Look read_at_once(std::uint64_t offset, std::span<std::byte> out) const noexcept;

  FileCalls* calls_ = nullptr;
  int descriptor_ = -1;
};

}  // namespace planetree::storage
