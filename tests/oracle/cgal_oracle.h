#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// Nearest triangles by CGAL's AABB tree in double, for models too large for
/// brute force. Triangles too thin for CGAL's double projection are left out of
/// its tree and looked at one by one.
class CgalOracle {
 public:
  /// `triangles` must outlive this.
  explicit CgalOracle(std::span<const Corners> triangles);
  ~CgalOracle();
  CgalOracle(const CgalOracle&) = delete;
  CgalOracle& operator=(const CgalOracle&) = delete;

  /// Distance to the nearest triangle. CGAL says which; how far it is is
  /// computed in long double.
  [[nodiscard]] long double distance(const Vec3& query) const;
  /// Triangles left out of the tree.
  [[nodiscard]] std::size_t thin_count() const;

 private:
  class Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace planetree::oracle
