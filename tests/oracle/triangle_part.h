#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// The boxes of some triangles in an R-tree (Boost.Geometry), to find those that a ball or a
/// ray may meet. None that does is left out; some that do not are found besides.
/// ClosestPointQuery is for any number of threads.
class TrianglePart {
 public:
  /// Indices are those in `triangles`, which are not none.
  explicit TrianglePart(std::span<const Corners> triangles);
  ~TrianglePart();
  TrianglePart(TrianglePart&&) noexcept;

  /// Appends the places of triangles whose boxes are no farther from `query` than `reach`.
  void find_near(const Vec3& query, double reach, std::vector<std::uint32_t>& found) const;
  /// Appends the places of triangles whose boxes the ray from `query` along +x meets.
  void find_ahead(const Vec3& query, std::vector<std::uint32_t>& found) const;

 private:
  class Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace planetree::oracle
