#pragma once

#include <cstddef>
#include <cstdint>

#include "planetree/error.h"

namespace planetree::cache {

/// Anonymous memory taken from the system once, all of it backed before the
/// claim returns, so that no later access faults a page in. Starts as zeros.
/// Move-only; gives everything back when destroyed.
class PrefaultedMemory {
 public:
  /// Claims at least `bytes`, which must not be 0. Fails with kNoMemory.
  static Result<PrefaultedMemory> claim(std::uint64_t bytes) noexcept;

  /// What claim(bytes) really takes: `bytes` rounded up to system pages, and to a huge page where
  /// little is missing.
  static std::uint64_t claimed_bytes(std::uint64_t bytes) noexcept;

  PrefaultedMemory(PrefaultedMemory&& other) noexcept;
  PrefaultedMemory& operator=(PrefaultedMemory&& other) noexcept;
  ~PrefaultedMemory();

  /// Keeps the system from paging it out; false where that is not allowed.
  bool lock() const noexcept;

  std::byte* data() const noexcept { return data_; }
  std::uint64_t bytes() const noexcept { return bytes_; }

 private:
  PrefaultedMemory(std::byte* data, std::uint64_t bytes) noexcept : data_(data), bytes_(bytes) {}

  std::byte* data_;
  std::uint64_t bytes_;
};

}  // namespace planetree::cache
