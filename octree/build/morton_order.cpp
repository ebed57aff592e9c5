#include "octree/build/morton_order.h"

#include <algorithm>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include "octree/octcode.h"
#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

std::uint32_t cell_coordinate(double from_lower) {
  constexpr double kCellsPerUnit = 1 << (kLevels - 1);
  constexpr double kLast = (1 << kLevels) - 1;
  return static_cast<std::uint32_t>(std::clamp(from_lower * kCellsPerUnit, 0.0, kLast));
}

std::uint64_t code_of(const Triangle& triangle, const Point& lower) {
  const Point least = triangle[0].cwiseMin(triangle[1]).cwiseMin(triangle[2]);
  const Point greatest = triangle[0].cwiseMax(triangle[1]).cwiseMax(triangle[2]);
  const Point centre = (least + greatest) * 0.5 - lower;
  return morton_code(cell_coordinate(centre.x()), cell_coordinate(centre.y()),
                     cell_coordinate(centre.z()));
}

}  // namespace

std::vector<MortonKey> morton_order(const MeshStore& mesh) {
  std::vector<MortonKey> keys(mesh.size());
  const Point lower = mesh.lower();
  using Range = tbb::blocked_range<std::uint32_t>;
  tbb::parallel_for(Range(0, mesh.size(), 4096), [&](const Range& range) {
    for (std::uint32_t i = range.begin(); i < range.end(); ++i)
      keys[i] = {code_of(mesh.corners(i), lower), i};
  });
  tbb::parallel_sort(keys.begin(), keys.end(), [](const MortonKey& a, const MortonKey& b) {
    return a.code < b.code || (a.code == b.code && a.position < b.position);
  });
  return keys;
}

}  // namespace planetree::octree
