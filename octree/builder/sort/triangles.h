#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "octree/geometry/triangle_distance.h"
#include "storage/spill/spill_runs.h"

namespace planetree::octree {

/// An array of triangles, stored as records: Morton code and index in the input, 8 bytes each, then
/// nine coordinates in float32 or float64.
class Triangles {
 public:
  explicit Triangles(bool float64 = false) : float64_(float64) {}
  /// records  whole records, with coordinates as `float64` says.
  Triangles(std::vector<std::byte> records, bool float64)
      : records_(std::move(records)), float64_(float64) {
    assert(records_.size() % record_bytes() == 0);
  }

  static constexpr std::size_t record_bytes(bool float64) {
    return sizeof(storage::SpillKey) + 9 * (float64 ? sizeof(double) : sizeof(float));
  }
  std::size_t record_bytes() const { return record_bytes(float64_); }

  bool float64() const { return float64_; }
  std::uint32_t size() const {
    return static_cast<std::uint32_t>(records_.size() / record_bytes());
  }

  /// The key that triangles are sorted by: code, then index.
  storage::SpillKey key(std::uint32_t position) const {
    storage::SpillKey key;
    std::memcpy(&key, at(position), sizeof key);
    return key;
  }
  std::uint64_t code(std::uint32_t position) const { return key(position).first; }
  std::uint64_t index(std::uint32_t position) const { return key(position).second; }
  Triangle corners(std::uint32_t position) const {
    const std::byte* const from = at(position) + sizeof(storage::SpillKey);
    return float64_ ? corners_of<double>(from) : corners_of<float>(from);
  }

  /// Adds a triangle. Coordinates are rounded to the type that is stored.
  void add(const storage::SpillKey& key, const Triangle& corners) {
    records_.resize(records_.size() + record_bytes());
    set(size() - 1, key, corners);
  }
  void set(std::uint32_t position, const storage::SpillKey& key, const Triangle& corners);

  void reserve(std::size_t count) { records_.reserve(count * record_bytes()); }
  /// Sorts the triangles by their keys.
  void sort();

  std::span<const std::byte> records() const { return records_; }
  std::vector<std::byte> take_records() { return std::move(records_); }

 private:
  const std::byte* at(std::uint32_t position) const {
    return records_.data() + position * record_bytes();
  }

  template <class Real>
  static Triangle corners_of(const std::byte* from) {
    Real values[9];
    std::memcpy(values, from, sizeof values);
    Triangle triangle;
    for (std::size_t k = 0; k < 3; ++k)
      triangle[k] = Point(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
    return triangle;
  }

  std::vector<std::byte> records_;
  bool float64_;
};

}  // namespace planetree::octree
