#pragma once

#include <liburing.h>

#include <chrono>
#include <cstdint>

#include "storage/system/file_calls.h"

namespace planetree::storage {

/// A wait with a time limit until the system has certain bytes of a file in memory.
///
/// pread(2) waits for as long as the device takes. This class submits a read of one byte to an
/// io_uring and waits for it until the limit. When the read completes, the system has the bytes
/// around that one in memory too. The byte itself is not used, so a read that completes late, or
/// after this object was destroyed, does no harm.
///
/// The first wait creates the io_uring, which takes a file descriptor and kMappedBytes of memory.
/// If the system refuses it, the object never waits. One thread at a time may use the object. If a
/// read completes late, a system call that the thread is making at that time may fail with EINTR.
class ReadWait {
 public:
  enum class Outcome : std::uint8_t {
    kCame,     ///< the byte is in memory
    kLate,     ///< the limit was reached
    kRefused,  ///< the system refuses the wait, or the read failed
  };

  /// Memory that the system maps for an io_uring, if its pages have 4 KiB.
  static constexpr std::uint64_t kMappedBytes = 2 * 4096;

  ReadWait() noexcept = default;
  ~ReadWait();
  ReadWait(const ReadWait&) = delete;
  ReadWait& operator=(const ReadWait&) = delete;

  /// Waits until the byte at `offset` is in memory. If an earlier read is still late, waits for
  /// that one first.
  /// calls   the system, the same in every call; must outlive this object.
  /// end     time limit.
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
