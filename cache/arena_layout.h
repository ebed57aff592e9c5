#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

namespace planetree::cache {

/// Cuts arrays off a piece of memory, each on its own cache line. Without
/// memory it only measures, so that measuring and cutting cannot disagree.
class ArenaLayout {
 public:
  explicit ArenaLayout(std::byte* base) noexcept : base_(base) {}

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
