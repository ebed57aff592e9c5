#pragma once

#include <array>

#include "tests/golden/spec_reader.h"

/// The exact signs of "Crossings of a perturbed segment", and what follows from them. Coordinates
/// are below 8 by magnitude, and multiples of 2^-200. Part of the independent reader: see
/// spec_reader.h.
namespace planetree::golden {

using SpecCorners = std::array<SpecPoint, 3>;

/// The side of the plane of a triangle that the perturbed point x is on.
int side_of_plane(const SpecPoint& x, const SpecCorners& triangle);

/// The change of the winding number from q to p that a triangle causes.
int crossing(const SpecPoint& p, const SpecPoint& q, const SpecCorners& triangle);

/// Whether a point is on the edge from u to v, or on a triangle.
bool is_on_edge(const SpecPoint& p, const SpecPoint& u, const SpecPoint& v);
bool is_on(const SpecPoint& p, const SpecCorners& triangle);

}  // namespace planetree::golden
