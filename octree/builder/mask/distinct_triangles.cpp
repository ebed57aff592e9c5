#include "octree/builder/mask/distinct_triangles.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

#include "octree/builder/sort/morton_order.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Compares the corners of triangles as sequences of numbers.
bool precedes(const Triangle& a, const Triangle& b) {
  return std::lexicographical_compare(
      a.begin(), a.end(), b.begin(), b.end(), [](const Point& p, const Point& q) {
        return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
      });
}

/// Joins the copies among the triangles from position `first` on.
void join_copies(std::vector<BoxedTriangle>& triangles, std::size_t first) {
  std::vector<std::size_t> order(triangles.size() - first);
  std::iota(order.begin(), order.end(), first);
  std::stable_sort(order.begin(), order.end(), [&triangles](std::size_t a, std::size_t b) {
    return precedes(triangles[a].corners, triangles[b].corners);
  });
  std::size_t kept = order[0];
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (triangles[order[i]].corners != triangles[kept].corners) {
      kept = order[i];
      continue;
    }
    triangles[kept].copies += std::exchange(triangles[order[i]].copies, 0);
    triangles[kept].is_cap |= triangles[order[i]].is_cap;
  }
  triangles.erase(
      std::remove_if(std::next(triangles.begin(), static_cast<std::ptrdiff_t>(first)),
                     triangles.end(),
                     [](const BoxedTriangle& triangle) { return triangle.copies == 0; }),
      triangles.end());
}

}  // namespace

std::vector<BoxedTriangle> distinct(const Triangles& triangles) {
  std::vector<BoxedTriangle> found;
  found.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size();) {
    const std::size_t first = found.size();
    for (const std::uint64_t code = triangles.code(i);
         i < triangles.size() && triangles.code(i) == code; ++i) {
      const Triangle corners = triangles.corners(i);
      // Copies mostly follow each other.
      if (found.size() > first && found.back().corners == corners)
        ++found.back().copies;
      else
        found.emplace_back(corners);
      found.back().is_cap |= is_cap(triangles.index(i));
    }
    if (found.size() - first > 1) join_copies(found, first);
  }
  return found;
}

}  // namespace planetree::octree
