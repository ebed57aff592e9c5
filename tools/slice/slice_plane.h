#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "planetree/model.h"

namespace planetree::tools {

/// A component of a vector: 0, 1, 2 for x, y, z.
[[nodiscard]] constexpr double component(const Vec3& vector, unsigned axis) {
  return axis == 0 ? vector.x : axis == 1 ? vector.y : vector.z;
}

/// A plane, such as "z=1.5", a coordinate in model units, or "z=50%", a share of the model's box.
struct SlicePlane {
  unsigned axis = 2;     ///< 0, 1, 2 for x, y, z
  double value = 0;      ///< model units or per cent
  bool percent = false;  ///< whether `value` is per cent of the box, from its lower side

  /// Empty if the text is not a plane.
  static std::optional<SlicePlane> parse(std::string_view text);
  /// The coordinate in model units.
  [[nodiscard]] double coordinate(const ModelInfo& info) const;
  /// What is wrong with a plane that does not meet the core, which the picture shows: the plane and
  /// the core's sides. Empty if it meets it.
  [[nodiscard]] std::string complaint(const ModelInfo& info) const;
};

}  // namespace planetree::tools
