#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// Nearest triangles by CGAL's AABB tree in double, for models too large for brute force. Triangles
/// too thin for CGAL's projection in double are kept out of its tree and evaluated one by one.
class CgalOracle {
 public:
  /// `triangles` must outlive this.
  explicit CgalOracle(std::span<const Corners> triangles);
  ~CgalOracle();
  CgalOracle(const CgalOracle&) = delete;
  CgalOracle& operator=(const CgalOracle&) = delete;

  /// Distance to the nearest triangle. CGAL finds the triangle; its distance is computed in long
  /// double.
  [[nodiscard]] long double distance(const Vec3& query) const;
  /// Number of triangles kept out of the tree.
  [[nodiscard]] std::size_t thin_count() const;

 private:
  class Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace planetree::oracle
