#pragma once

#include <array>
#include <vector>

#include "planetree/types.h"

namespace planetree::octree {

/// The faces of an octahedron of radius 1, facing outward, each divided into 4^`levels`. An edge
/// from a to b is divided at middle(a, b). The surface is watertight if middle(a, b) equals
/// middle(b, a).
template <class Middle>
class DividedOctahedron {
 public:
  using Face = std::array<Vec3, 3>;

  DividedOctahedron(unsigned levels, const Middle& middle) : middle_(middle) {
    for (unsigned octant = 0; octant < 8; ++octant) {
      const double x = octant & 1 ? -1 : 1, y = octant & 2 ? -1 : 1, z = octant & 4 ? -1 : 1;
      const Vec3 a{x, 0, 0}, b{0, y, 0}, c{0, 0, z};
      divide(x * y * z > 0 ? Face{a, b, c} : Face{a, c, b}, levels);
    }
  }

  const std::vector<Face>& faces() const { return faces_; }

 private:
  void divide(const Face& face, unsigned levels) {
    if (levels == 0) {
      faces_.push_back(face);
      return;
    }
    const auto& [a, b, c] = face;
    const Vec3 ab = middle_(a, b), bc = middle_(b, c), ca = middle_(c, a);
    divide({a, ab, ca}, levels - 1);
    divide({ab, b, bc}, levels - 1);
    divide({ca, bc, c}, levels - 1);
    divide({ab, bc, ca}, levels - 1);
  }

  const Middle& middle_;
  std::vector<Face> faces_;
};

}  // namespace planetree::octree
