#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>

#include "storage/system/file_calls.h"

namespace planetree::tools {

/// A disk whose reads take simulated time: it reads the real file at once and then calls a function
/// that lets the time pass. One thread at a time.
class SimulatedDisk final : public storage::FileCalls {
 public:
  /// Sets what to call after each read from now on.
  void on_read(std::function<void()> wait) { wait_ = std::move(wait); }

  ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept override {
    const ssize_t read = FileCalls::pread(descriptor, out, bytes, offset);
    if (wait_) wait_();
    return read;
  }

 private:
  std::function<void()> wait_;
};

/// Nanoseconds of simulated time.
class SimulatedClock {
 public:
  std::uint64_t now_ns() const noexcept { return now_ns_; }
  /// Lets the time pass up to `time_ns`, if that is later.
  void pass_until(std::uint64_t time_ns) noexcept {
    if (time_ns > now_ns_) now_ns_ = time_ns;
  }

 private:
  std::uint64_t now_ns_ = 0;
};

}  // namespace planetree::tools
