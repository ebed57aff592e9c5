#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// The boxes of some triangles in an R-tree (Boost.Geometry), to find the triangles that a ball or
/// a ray may meet. Every triangle that does meet it is found; some others are found too. Any number
/// of threads may search at once.
class TrianglePart {
 public:
  /// Indices refer to `triangles`, which must not be empty.
  explicit TrianglePart(std::span<const Corners> triangles);
  ~TrianglePart();
  TrianglePart(TrianglePart&&) noexcept;

  /// Appends the indices of triangles whose boxes are no farther from `query` than `reach`.
  void find_near(const Vec3& query, double reach, std::vector<std::uint32_t>& found) const;
  /// Appends the indices of triangles whose boxes the ray from `query` along +x meets.
  void find_ahead(const Vec3& query, std::vector<std::uint32_t>& found) const;

 private:
  class Tree;
  std::unique_ptr<const Tree> tree_;
};

}  // namespace planetree::oracle
