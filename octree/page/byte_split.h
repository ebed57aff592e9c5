#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace planetree::octree {

/// View of a byte-stream split array: byte k of element i is at [k * count + i].
template <class T>
class ByteSplit {
 public:
  ByteSplit() = default;
  ByteSplit(const std::byte* bytes, std::size_t count) : bytes_(bytes), count_(count) {}
  static constexpr std::size_t bytes_for(std::size_t count) { return count * sizeof(T); }
  std::size_t size() const { return count_; }
  const std::byte* bytes() const { return bytes_; }

  T operator[](std::size_t index) const {
    using Bits = std::conditional_t<
        sizeof(T) == 8, std::uint64_t,
        std::conditional_t<sizeof(T) == 4, std::uint32_t,
                           std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;
    Bits bits = 0;
#pragma GCC unroll 8
    for (std::size_t k = 0; k < sizeof(T); ++k)
      bits = static_cast<Bits>(bits | static_cast<Bits>(bytes_[k * count_ + index]) << (8 * k));
    T value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

 private:
  const std::byte* bytes_ = nullptr;
  std::size_t count_ = 0;
};

/// Takes arrays off the front of a span of bytes. Once the bytes do not suffice, all further arrays
/// are empty.
class StreamReader {
 public:
  explicit StreamReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  template <class T>
  void take(ByteSplit<T>& stream, std::size_t count) {
    const std::size_t bytes = ByteSplit<T>::bytes_for(count);
    const std::byte* start = skip(bytes);
    stream = start ? ByteSplit<T>(start, count) : ByteSplit<T>();
  }
  std::span<const std::byte> take_bytes(std::size_t bytes) {
    const std::byte* start = skip(bytes);
    return start ? std::span(start, bytes) : std::span<const std::byte>();
  }
  /// Returns whether the bytes have sufficed for every array.
  bool has_sufficed() const { return ok_; }
  bool empty() const { return rest_.empty(); }

 private:
  const std::byte* skip(std::size_t bytes) {
    if (!ok_ || bytes > rest_.size()) {
      ok_ = false;
      return nullptr;
    }
    const std::byte* start = rest_.data();
    rest_ = rest_.subspan(bytes);
    return start;
  }

  std::span<const std::byte> rest_;
  bool ok_ = true;
};

}  // namespace planetree::octree
