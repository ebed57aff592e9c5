#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

/// Part of the independent reader: see spec_reader.h.
namespace planetree::golden {

inline void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

/// Reads streams from the front of the raw bytes.
class StreamReader {
 public:
  explicit StreamReader(std::span<const std::byte> bytes) : rest_(bytes) {}

  std::span<const std::byte> bytes(std::size_t count) {
    require(count <= rest_.size(), "the page is too short");
    const auto taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }
  /// Byte k of element i is at k * count + i.
  template <class T>
  std::vector<T> byte_split(std::size_t count) {
    const auto stream = bytes(count * sizeof(T));
    std::vector<T> values(count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < sizeof(T); ++k)
        reinterpret_cast<std::byte*>(&values[i])[k] = stream[k * count + i];
    return values;
  }
  template <class Narrow, class Wide>
  std::vector<Wide> either(bool wide, std::size_t count) {
    if (wide) return byte_split<Wide>(count);
    const std::vector<Narrow> values = byte_split<Narrow>(count);
    return {values.begin(), values.end()};
  }
  bool empty() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

}  // namespace planetree::golden
