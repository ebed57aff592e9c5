#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

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

  /// Reserves addresses for `bytes` bytes, not 0, without memory. commit() backs parts of them.
  /// errors  kNoMemory.
  static Result<PrefaultedMemory> reserve(std::uint64_t bytes) noexcept;

  /// Bytes that claim(bytes) takes: `bytes` rounded up to whole system pages. Sizes from 1.5 to
  /// 2 MiB are rounded up to a huge page of 2 MiB.
  static std::uint64_t claimed_bytes(std::uint64_t bytes) noexcept;

  PrefaultedMemory(PrefaultedMemory&& other) noexcept;
  PrefaultedMemory& operator=(PrefaultedMemory&& other) noexcept;
  ~PrefaultedMemory();

  /// Backs the system pages that this part lies in, which may be backed already, as claim() does.
  /// Memory that was not backed before is zero.
  ///
  /// is_locked  whether to lock the memory too, see lock(). A refusal is ignored.
  /// errors     kNoMemory.
  Result<void> commit(std::uint64_t offset, std::uint64_t bytes, bool is_locked) const noexcept;
  /// Gives the memory of whole system pages in this part back to the system. Their content is lost;
  /// commit() must back them before the next access.
  void discard(std::uint64_t offset, std::uint64_t bytes) const noexcept;

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

/// Lays out arrays one after another in a piece of memory. Each array starts on a cache line.
/// With a null base it only adds up the bytes, so that the size computed in advance and the
/// layout cannot disagree. Does not own the memory.
class ArenaLayout {
 public:
  explicit ArenaLayout(std::byte* base) noexcept : base_(base) {}

  /// Returns the next `count` elements, value-initialized; an empty span with a null base.
  template <class T>
  std::span<T> cut(std::uint64_t count) noexcept {
    static_assert(std::is_trivially_destructible_v<T>, "nobody runs destructors here");
    static_assert(alignof(T) <= kLineBytes);
    const std::uint64_t start = used_bytes_;
    used_bytes_ += (count * sizeof(T) + kLineBytes - 1) / kLineBytes * kLineBytes;
    if (base_ == nullptr) return {};
    T* first = reinterpret_cast<T*>(base_ + start);
    std::uninitialized_value_construct_n(first, count);
    return {first, count};
  }

  std::uint64_t used_bytes() const noexcept { return used_bytes_; }

 private:
  static constexpr std::uint64_t kLineBytes = 64;

  std::byte* base_;
  std::uint64_t used_bytes_ = 0;
};

}  // namespace planetree::cache
