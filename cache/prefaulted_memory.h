#pragma once

#include <cstddef>
#include <cstdint>

#include "planetree/error.h"

namespace planetree::cache {

/// Anonymous memory of the process, initially zero. All of it is backed by physical memory before
/// claim() returns, so that no later access faults a page in. Move-only. The destructor returns
/// the memory to the system.
class PrefaultedMemory {
 public:
  /// Claims at least `bytes` bytes; `bytes` must not be 0.
  /// errors  kNoMemory.
  static Result<PrefaultedMemory> claim(std::uint64_t bytes) noexcept;

  /// Bytes that claim(bytes) takes: `bytes` rounded up to whole system pages. Sizes from 1.5 to
  /// 2 MiB are rounded up to a huge page of 2 MiB.
  static std::uint64_t claimed_bytes(std::uint64_t bytes) noexcept;

  PrefaultedMemory(PrefaultedMemory&& other) noexcept;
  PrefaultedMemory& operator=(PrefaultedMemory&& other) noexcept;
  ~PrefaultedMemory();

  /// Locks the memory, so that the system does not page it out. Returns false if the system
  /// refuses.
  bool lock() const noexcept;

  std::byte* data() const noexcept { return data_; }
  std::uint64_t bytes() const noexcept { return bytes_; }

 private:
  PrefaultedMemory(std::byte* data, std::uint64_t bytes) noexcept : data_(data), bytes_(bytes) {}

  std::byte* data_;
  std::uint64_t bytes_;
};

}  // namespace planetree::cache
