#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tests/golden/attributes/spec_attributes.h"

/// The mesh of painted_sample(), read without the library.
namespace planetree::golden {

/// What the mesh has for an index.
struct PaintedTriangle {
  std::array<SpecPoint, 3> corners;  ///< as in the mesh
  SpecColours colours;
  SpecUvs uvs;
  double value;
};

/// The triangles by their indices. An index of the skipped face has none.
std::vector<std::optional<PaintedTriangle>> painted_triangles();

}  // namespace planetree::golden
