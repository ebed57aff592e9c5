#pragma once

#include <cstddef>
#include <cstring>
#include <utility>
#include <vector>

namespace planetree::octree {

/// Appends arrays, plain or with byte-stream split: all first bytes, then all second bytes, and so
/// on.
class StreamWriter {
 public:
  template <class T>
  void byte_split(const std::vector<T>& values) {
    const std::size_t start = bytes_.size();
    bytes_.resize(start + values.size() * sizeof(T));
    for (std::size_t i = 0; i < values.size(); ++i) {
      std::byte element[sizeof(T)];
      std::memcpy(element, &values[i], sizeof(T));
      for (std::size_t k = 0; k < sizeof(T); ++k)
        bytes_[start + k * values.size() + i] = element[k];
    }
  }

  void plain(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t start = bytes_.size();
    bytes_.resize(start + size);
    std::memcpy(bytes_.data() + start, data, size);
  }

  std::size_t size() const { return bytes_.size(); }
  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace planetree::octree
