#pragma once

#include <cstdint>
#include <span>

#include "planetree/types.h"
#include "tests/oracle/brute_force.h"

/// Pseudo-normals by looking at every triangle, with 512 bits where it counts.
namespace planetree::oracle {

struct ReferenceNormal {
  Vec3 normal{0, 0, 0};  ///< of length 1, as the mesh is oriented; 0 if no face has an area
  double certainty = 0;  ///< length of the sum as a share of its terms
};

/// Of the feature of `triangle` that `barycentric` names by its zeros.
ReferenceNormal reference_normal(std::span<const Corners> triangles, std::uint64_t triangle,
                                 const Vec3& barycentric);

}  // namespace planetree::oracle
