#include "tools/slice/slice_plane.h"

#include <fmt/format.h>

#include <cmath>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::tools {

std::optional<SlicePlane> SlicePlane::parse(std::string_view text) {
  if (text.size() < 3 || text[1] != '=') return std::nullopt;
  const char letter = static_cast<char>(text[0] | 0x20);
  if (letter < 'x' || letter > 'z') return std::nullopt;
  SlicePlane plane;
  plane.axis = static_cast<unsigned>(letter - 'x');
  text.remove_prefix(2);
  plane.percent = text.ends_with('%');
  if (plane.percent) text.remove_suffix(1);
  if (!octree::parse_real(text, plane.value) || !std::isfinite(plane.value)) return std::nullopt;
  return plane;
}

double SlicePlane::coordinate(const ModelInfo& info) const {
  if (!percent) return value;
  const double share = value / 100;
  return component(info.core_lower, axis) * (1 - share) + component(info.core_upper, axis) * share;
}

std::string SlicePlane::complaint(const ModelInfo& info) const {
  const double at = coordinate(info);
  const double lower = component(info.core_lower, axis), upper = component(info.core_upper, axis);
  if (lower <= at && at <= upper) return {};
  const char letter = "xyz"[axis];
  const std::string plane = percent
                                ? fmt::format("{}={:.9g}%, {}={:.9g},", letter, value, letter, at)
                                : fmt::format("{}={:.9g}", letter, value);
  const std::string box = info.strays == 0
                              ? "the model's box"
                              : fmt::format("the box of all triangles but {} strays", info.strays);
  return fmt::format(
      "the plane {} is outside of {}, where {} is from {:.9g} to {:.9g}; give a {} between them to "
      "cut the surface",
      plane, box, letter, lower, upper, letter);
}

}  // namespace planetree::tools
