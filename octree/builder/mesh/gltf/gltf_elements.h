#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "octree/builder/mesh/gltf/gltf_arrays.h"
#include "octree/builder/mesh/stream/mesh_window.h"
#include "planetree/error.h"

namespace planetree::octree {

/// What the numbers of a sequence are divided by: the largest integer of their type if they are
/// normalized, otherwise 0 for nothing.
double unit_of(const GltfSequence& sequence);
/// Reads a number of an element and divides it by the unit of its sequence.
inline double number_at(ScalarType type, const std::byte* at, double unit) {
  const double number = load_real(type, at, kSwapLittle);
  return unit == 0 ? number : std::max(number / unit, -1.0);
}

/// Reads the elements of an accessor, fastest where their numbers ascend.
class GltfElementReader {
 public:
  /// window_bytes  of memory for each of the arrays.
  GltfElementReader(const GltfSequence& sequence, std::size_t window_bytes);

  /// The bytes of an element, in the file's type and byte order; valid until the next call. Null if
  /// they cannot be read: see failure().
  const std::byte* at(std::uint64_t element);
  [[nodiscard]] const Error& failure() const { return *failure_; }

 private:
  /// The part of an array that is in memory.
  struct Source {
    Source(const GltfArray& elements, std::size_t window_bytes);
    const std::byte* at(std::uint64_t element);

    GltfArray array;
    std::unique_ptr<MeshWindow> window;  ///< null if the elements are zero or there are none
  };

  const std::byte* read(Source& source, std::uint64_t element);
  /// Sets next_sparse_ to the first sparse element that is not before an element. False if it
  /// cannot be read.
  bool seek(std::uint64_t element);
  bool read_index(std::uint64_t sparse, std::uint64_t& index);

  Source base_, indices_, values_;
  std::uint64_t next_sparse_ = 0;   ///< the first one at or behind next_element_
  std::uint64_t sparse_index_ = 0;  ///< the element it replaces; behind the last one if none
  std::uint64_t next_element_ = 0;
  bool is_ready_ = false;
  std::optional<Error> failure_;
};

}  // namespace planetree::octree
