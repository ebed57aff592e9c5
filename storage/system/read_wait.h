#pragma once

#include <liburing.h>

#include <chrono>
#include <cstdint>

#include "storage/system/file_calls.h"

namespace planetree::storage {

/// A wait in the system, with a limit, for bytes of a file that a device is to give.
///
/// pread(2) waits for as long as the device takes. An io_uring is told to read one byte, and is
/// waited for as long as one may: nobody looks at that byte, so that a read which comes late, or
/// after this is gone, harms nothing. What it is good for is that the system then has in memory
/// what lies about the byte.
///
/// Made when it is first needed, of a descriptor and kMappedBytes; where the system refuses, it
/// never waits. For one thread at a time; that may be now this one, now that. Where a read comes
/// late, a call of the system that the thread makes then may end with EINTR.
class ReadWait {
 public:
  enum class Outcome : std::uint8_t {
    kCame,
    kLate,     ///< the limit was reached
    kRefused,  ///< cannot be waited for, or cannot be read
  };

  /// Of memory that the system maps, where its pages have 4 KiB.
  static constexpr std::uint64_t kMappedBytes = 2 * 4096;

  ReadWait() noexcept = default;
  ~ReadWait();
  ReadWait(const ReadWait&) = delete;
  ReadWait& operator=(const ReadWait&) = delete;

  /// Until the byte at `offset` is in memory. While an earlier one is late, for that one first.
  /// calls   the system, each time the same; must outlive this.
  Outcome wait_until(FileCalls& calls, int descriptor, std::uint64_t offset,
                     std::chrono::steady_clock::time_point end) noexcept;

 private:
  using Clock = std::chrono::steady_clock;
  enum class State : std::uint8_t { kNew, kIdle, kReading, kRefused };

  void open(FileCalls& calls) noexcept;
  void start(int descriptor, std::uint64_t offset) noexcept;
  Outcome finish(Clock::time_point end) noexcept;
  void give_up() noexcept;

  FileCalls* calls_ = nullptr;
  io_uring ring_{};
  State state_ = State::kNew;
};

}  // namespace planetree::storage
