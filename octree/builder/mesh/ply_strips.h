#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "octree/builder/mesh/stream/indexed_face.h"
#include "octree/builder/mesh/stream/mesh_note.h"
#include "octree/builder/mesh/stream/scalar_type.h"

namespace planetree::octree {

/// Cuts triangle strips into triangles. A strip goes on with each index of a list; an index of -1
/// ends it, and the end of the list does. Each index from the third of a strip on makes a triangle
/// with the two before it. The second, fourth and so on of a strip are turned, so that all face the
/// same way. A triangle that names a vertex twice only leads on to the next one: it is left out,
/// and takes no number.
class PlyStrips {
 public:
  /// type  of the indices in the file.
  explicit PlyStrips(ScalarType type) : type_(type) {}

  void begin_list() { length_ = 0; }
  /// Takes the next index of a list. True if it makes a triangle.
  bool add(std::int64_t index, std::uint64_t line) {
    if (is_end(index)) {
      length_ = 0;
      return false;
    }
    last_ = {last_[1], last_[2], index};
    if (++length_ < 3) return false;
    const auto& [a, b, c] = last_;
    if (a != b && b != c && c != a) return true;
    left_out_.add(line);
    return false;
  }
  /// The triangle that the last index made; valid until the next index.
  [[nodiscard]] IndexedFace triangle() {
    const auto& [a, b, c] = last_;
    const bool is_turned = length_ % 2 == 0;
    triangle_ = is_turned ? std::array{b, a, c} : last_;
    return {number_, triangle_};
  }
  [[nodiscard]] std::uint64_t number() const { return number_; }
  void count_triangle() { ++number_; }
  [[nodiscard]] const MeshNote& left_out() const { return left_out_; }

 private:
  [[nodiscard]] bool is_end(std::int64_t index) const {
    if (index == -1) return true;
    if (type_ == ScalarType::kUint32) return index == std::numeric_limits<std::uint32_t>::max();
    return type_ == ScalarType::kUint64 && index == std::numeric_limits<std::int64_t>::max();
  }

  ScalarType type_;
  std::array<std::int64_t, 3> last_ = {}, triangle_ = {};
  std::uint64_t length_ = 0;  ///< of the strip so far
  std::uint64_t number_ = 0;  ///< of the next triangle
  MeshNote left_out_;
};

}  // namespace planetree::octree
