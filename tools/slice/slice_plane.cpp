#include "tools/slice/slice_plane.h"

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

}  // namespace planetree::tools
