#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// Sides by CGAL's Side_of_triangle_mesh, with exact predicates.
class CgalSide {
 public:
  /// Takes a closed surface; corners at equal positions are one vertex.
  explicit CgalSide(std::span<const Corners> triangles);
  ~CgalSide();
  CgalSide(const CgalSide&) = delete;
  CgalSide& operator=(const CgalSide&) = delete;

  /// Whether CGAL accepts the triangles as a closed mesh; if not, side() must not be called.
  [[nodiscard]] bool usable() const;
  [[nodiscard]] Side side(const Vec3& query) const;

 private:
  class Mesh;
  std::unique_ptr<Mesh> mesh_;
};

}  // namespace planetree::oracle
