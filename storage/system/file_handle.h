#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/error.h"
#include "storage/system/file_calls.h"
#include "storage/system/read_wait.h"

namespace planetree::storage {

/// Time limits of a read whose bytes the system may not have in memory.
struct ReadLimits {
  /// Maximum time to poll for the bytes without giving up the processor. The default is about the
  /// time that it takes to put a thread to sleep and wake it.
  std::chrono::microseconds max_poll{300};
  /// The ReadWait to wait with, used by no other thread meanwhile; null: only poll.
  ReadWait* wait = nullptr;
  /// Maximum time to wait with `wait`.
  std::chrono::microseconds max_wait{0};
  /// Memory that the caller writes next. It is prefetched while the device works.
  std::span<const std::byte> prefetch_for_write{};
};

/// An open file; the destructor closes it. Reads and writes name their offset, so any number of
/// threads may share a handle.
class FileHandle {
 public:
  FileHandle() noexcept = default;
  FileHandle(FileHandle&& other) noexcept;
  FileHandle& operator=(FileHandle&& other) noexcept;
  ~FileHandle();

  /// Calls openat(2) with close-on-exec, and again when a signal interrupts it. On failure the
  /// handle is not open and errno says why.
  /// calls  the system; must outlive the handle.
  static FileHandle open(FileCalls& calls, int directory, const char* path, int flags,
                         mode_t mode = 0) noexcept;

  bool is_open() const noexcept { return descriptor_ >= 0; }
  int descriptor() const noexcept { return descriptor_; }
  FileCalls& calls() const noexcept { return *calls_; }
  void close() noexcept;

  /// Fills `out` with the bytes from `offset` on. Continues after interruptions and short reads.
  /// what    the action to name in an error; see file_error().
  /// errors  kTruncated: the file ends too early; otherwise those of file_error().
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out,
                       const char* what = "read the file") const noexcept;

  /// Fills `out` with the bytes from `offset` on if the system has them in memory or gets them
  /// within the limits of `terms`. If they are not in memory, it advises the system to read them
  /// and waits with terms.wait. Without terms.wait, or where the system refuses that wait, it polls
  /// without giving up the processor.
  ///
  /// Returns false if the bytes do not come in time, the system cannot read without blocking, or
  /// reading fails. The content of `out` is then unspecified. Call read_at() to read the bytes or
  /// to learn the error.
  bool try_read(std::uint64_t offset, std::span<std::byte> out,
                const ReadLimits& terms) const noexcept;

  /// Writes all of `bytes` at `offset`. Continues after interruptions and short writes.
  /// what    the action to name in an error; see file_error().
  /// errors  those of file_error(), among them kNoSpace.
  Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes,
                        const char* what = "write the file") const noexcept;

  /// errors  those of file_error().
  Result<std::uint64_t> size_bytes() const noexcept;

  /// Sets the length of the file, durably.
  /// errors  those of file_error().
  Result<void> truncate(std::uint64_t bytes) const noexcept;

  /// Makes the bytes written so far durable. After an error it is unknown which bytes are durable,
  /// and a second call might not report the loss again.
  /// errors  those of file_error().
  Result<void> sync_data() const noexcept;

 private:
  /// Which bytes the system has in memory. kPart includes "none yet"; kNever means that the read
  /// fails or the file ends too early.
  enum class Found : std::uint8_t { kAll, kPart, kNever };
  struct Poll {
    Found found;
    std::size_t bytes;  // number of bytes read, from the first on
  };
  Poll poll_once(std::uint64_t offset, std::span<std::byte> out) const noexcept;
  bool poll_until(std::chrono::steady_clock::time_point end, std::uint64_t offset,
                  std::span<std::byte> out) const noexcept;

  FileCalls* calls_ = nullptr;
  int descriptor_ = -1;
};

}  // namespace planetree::storage
