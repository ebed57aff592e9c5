#include "octree/builder/sort/morton_order.h"

#include <algorithm>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

std::uint32_t cell_coordinate(double from_lower) {
  constexpr double kCellsPerUnit = 1 << (kLevels - 1);
  constexpr double kLast = (1 << kLevels) - 1;
  return static_cast<std::uint32_t>(std::clamp(from_lower * kCellsPerUnit, 0.0, kLast));
}

}  // namespace

std::uint64_t morton_code_of(const Triangle& triangle, const Point& lower) {
  const Point centre = (least_corner(triangle) + greatest_corner(triangle)) * 0.5 - lower;
  return morton_code(cell_coordinate(centre.x()), cell_coordinate(centre.y()),
                     cell_coordinate(centre.z()));
}

std::vector<MortonKey> keys_of(const Triangles& sorted) {
  std::vector<MortonKey> keys(sorted.size());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) keys[i] = {morton_part(sorted.code(i)), i};
  return keys;
}

}  // namespace planetree::octree
