#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "octree/builder/mesh/stream/corner_attributes.h"
#include "planetree/error.h"
#include "planetree/types.h"

namespace planetree::octree {

/// Records of one size by index, wherever they are stored.
class MeshRecords {
 public:
  virtual ~MeshRecords() = default;

  [[nodiscard]] virtual std::uint64_t count() const = 0;
  [[nodiscard]] virtual std::size_t record_bytes() const = 0;
  /// Reads the records from `first` on, as many as fit in `out`. All of them are below count().
  virtual Result<void> read(std::uint64_t first, std::span<std::byte> out) = 0;
};

/// The vertices of a mesh by index. A record is a position, which is three floats or three doubles
/// side by side in the machine's byte order, and the attributes that are kept (put_attributes()).
class MeshVertices : public MeshRecords {
 public:
  /// Whether positions are floats.
  [[nodiscard]] virtual bool float32() const = 0;
  /// The attributes that vertices have, of kCornerAttributes.
  [[nodiscard]] virtual std::uint32_t attributes() const { return 0; }

  [[nodiscard]] std::size_t position_bytes() const {
    return 3 * (float32() ? sizeof(float) : sizeof(double));
  }
  [[nodiscard]] std::size_t record_bytes() const final {
    return position_bytes() + attribute_bytes(attributes());
  }
};

/// Reads a position in the form that MeshVertices has.
inline Vec3 position_at(const std::byte* at, bool float32) noexcept {
  if (float32) {
    float values[3];
    std::memcpy(values, at, sizeof values);
    return {static_cast<double>(values[0]), static_cast<double>(values[1]),
            static_cast<double>(values[2])};
  }
  double values[3];
  std::memcpy(values, at, sizeof values);
  return {values[0], values[1], values[2]};
}

/// Writes a position in that form. With `float32` its coordinates must be floats.
inline void put_position(const Vec3& position, bool float32, std::byte* to) noexcept {
  if (float32) {
    const float values[] = {static_cast<float>(position.x), static_cast<float>(position.y),
                            static_cast<float>(position.z)};
    std::memcpy(to, values, sizeof values);
    return;
  }
  const double values[] = {position.x, position.y, position.z};
  std::memcpy(to, values, sizeof values);
}

}  // namespace planetree::octree
