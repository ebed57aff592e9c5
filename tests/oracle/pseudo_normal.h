#pragma once

#include <cstdint>
#include <span>

#include "planetree/types.h"
#include "tests/oracle/brute_force.h"

/// Pseudo-normals from all triangles by brute force, with 512 bits where precision matters.
namespace planetree::oracle {

struct ReferenceNormal {
  Vec3 normal{0, 0, 0};  ///< length 1, by the mesh's orientation; 0 if no face has an area
  double certainty = 0;  ///< length of the sum divided by the sum of its weights
};

/// Pseudo-normal at the feature of `triangle` that the zeros of `barycentric` select.
ReferenceNormal reference_normal(std::span<const Corners> triangles, std::uint64_t triangle,
                                 const Vec3& barycentric);

}  // namespace planetree::oracle
