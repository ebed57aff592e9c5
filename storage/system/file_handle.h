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

/// How a thread goes about bytes that a device is to give.
struct SoonTerms {
  /// How long it may look for them: about as long as it takes to be put to sleep and woken.
  std::chrono::microseconds max_looked{300};
  /// The thread's, and how long it may wait by it; null: it only looks.
  ReadWait* wait = nullptr;
  std::chrono::microseconds max_waited{0};
  /// What it writes next: brought near the processor while the device works.
  std::span<const std::byte> soon_written{};
};

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
  /// and they are waited for or, where that is refused, looked for again and again without giving
  /// up the processor. False where that takes longer than the terms allow, the system cannot be
  /// told, or reading fails: read_at() says why. `out` is lost then.
  bool read_soon(std::uint64_t offset, std::span<std::byte> out,
                 const SoonTerms& terms) const noexcept;

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
  enum class Found : std::uint8_t { kAll, kPart, kNever };  // part: perhaps nothing, as yet
  struct Look {
    Found found;
    std::size_t bytes;  // from the first
  };
  Look look_once(std::uint64_t offset, std::span<std::byte> out) const noexcept;
  bool look_until(std::chrono::steady_clock::time_point end, std::uint64_t offset,
                  std::span<std::byte> out) const noexcept;

  FileCalls* calls_ = nullptr;
  int descriptor_ = -1;
};

}  // namespace planetree::storage
