#pragma once

#include <cstddef>
#include <span>

#include "octree/page/raw_streams.h"

namespace planetree::octree {

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
