#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

namespace planetree::cache {

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
